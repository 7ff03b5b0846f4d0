# A room is one library, sphvv::NAME, with its tests beside it.

# Headers are named "sphvv/ROOM/…" in the tree and after installation alike.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/sphvv SYMBOLIC)

add_library(sphvv_options INTERFACE)
target_compile_features(sphvv_options INTERFACE cxx_std_20)
target_compile_options(sphvv_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual -Wno-psabi
  -Wzero-as-null-pointer-constant -Wredundant-decls
  $<$<CXX_COMPILER_ID:Clang>:-Wreserved-identifier>
  # GCC 12 takes the undefined register of its own AVX-512 intrinsics for a fault (GCC bug 105593), and inlined
  # std::string concatenation for overlapping copies (bug 105651).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-restrict>
  # Clang says which `omp simd` loops it leaves as they are: at -O1, all.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-pass-failed>
  $<$<BOOL:${SPHVV_WARNINGS_AS_ERRORS}>:-Werror>
  $<$<AND:$<BOOL:${SPHVV_MARCH}>,$<CONFIG:Release>>:-march=${SPHVV_MARCH}>
  # Sums over neighbours carry their own `omp simd reduction`; no other reassociation is allowed, so that the
  # same binary gives the same bits. Neither errno nor trapping is used.
  -fno-math-errno -fno-trapping-math)
target_link_libraries(sphvv_options INTERFACE OpenMP::OpenMP_CXX)
if(SPHVV_SANITIZE)
  target_compile_options(sphvv_options INTERFACE -fsanitize=${SPHVV_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(sphvv_options INTERFACE -fsanitize=${SPHVV_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND NOT SPHVV_SANITIZE_EIGEN)
    target_compile_options(sphvv_options INTERFACE -fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/sanitizers_leave_out.txt)
  endif()
endif()

# sphvv_room(NAME SOURCES … LINK …): the library sphvv::NAME.
function(sphvv_room name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  add_library(sphvv_${name} STATIC ${arg_SOURCES})
  add_library(sphvv::${name} ALIAS sphvv_${name})
  set_target_properties(sphvv_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_compile_features(sphvv_${name} PUBLIC cxx_std_20)
  target_include_directories(sphvv_${name} SYSTEM PUBLIC ${HDF5_C_INCLUDE_DIRS})
  target_include_directories(sphvv_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(sphvv_${name} PUBLIC ${arg_LINK} PRIVATE $<BUILD_INTERFACE:sphvv_options>)
endfunction()

# All programs of the label `unit`, and nothing else: what the sanitizers need.
add_custom_target(unit_tests)

# sphvv_test(ROOM NAME LABEL): the GoogleTest program ROOM/tests/NAME.cpp, one CTest test with that label.
function(sphvv_test room name label)
  add_executable(${room}_${name} ${CMAKE_CURRENT_SOURCE_DIR}/tests/${name}.cpp)
  target_link_libraries(${room}_${name} PRIVATE sphvv::${room} sphvv_options GTest::gtest_main ${ARGN})
  add_test(NAME ${room}.${name} COMMAND ${room}_${name})
  if(label STREQUAL "unit")
    add_dependencies(unit_tests ${room}_${name})
  endif()
  # Threads that spin while they wait would take the processor from the tests beside them.
  set_tests_properties(${room}.${name} PROPERTIES LABELS ${label} ENVIRONMENT OMP_WAIT_POLICY=passive)
endfunction()

# Everything that scripts/fuzz runs.
add_custom_target(fuzz_targets)

# sphvv_fuzz(ROOM NAME READERS … [MUTATOR …] LINK …): the fuzz target ROOM/fuzz/NAME.cpp. In every build a program replays the
# corpus ROOM/fuzz/corpus/NAME, one CTest test of the label `unit`. With SPHVV_FUZZ, fuzz/ROOM.NAME searches for more; only the
# target and READERS, all that it reaches of ours, are compiled for that, with a look at every branch, and not the whole room.
function(sphvv_fuzz room name)
  cmake_parse_arguments(arg "" "" "READERS;MUTATOR;LINK" ${ARGN})
  list(TRANSFORM arg_READERS PREPEND ${PROJECT_SOURCE_DIR}/)
  set(sources ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/${name}.cpp ${arg_READERS})
  set(programs ${room}_fuzz_${name}_replay)
  add_executable(${programs} ${sources} ${PROJECT_SOURCE_DIR}/solver/fuzz/replay.cpp)
  add_dependencies(unit_tests ${programs})
  add_test(NAME ${room}.fuzz_${name} COMMAND ${programs} ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/corpus/${name})
  set_tests_properties(${room}.fuzz_${name} PROPERTIES LABELS unit)
  if(SPHVV_FUZZ)
    list(APPEND programs ${room}_fuzz_${name})
    add_executable(${room}_fuzz_${name} ${sources} ${arg_MUTATOR})
    target_compile_options(${room}_fuzz_${name} PRIVATE -fsanitize=fuzzer-no-link)
    target_compile_definitions(${room}_fuzz_${name} PRIVATE FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION)
    add_dependencies(fuzz_targets ${programs}) # scripts/fuzz replays what it finds
    target_link_options(${room}_fuzz_${name} PRIVATE -fsanitize=fuzzer)
    set_target_properties(${room}_fuzz_${name} PROPERTIES OUTPUT_NAME ${room}.${name}
                          RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/fuzz)
  endif()
  foreach(program IN LISTS programs)
    target_include_directories(${program} PRIVATE ${PROJECT_BINARY_DIR}/include)
    target_link_libraries(${program} PRIVATE ${arg_LINK} sphvv_options)
  endforeach()
endfunction()

# sphvv_registry(ROOM FOLDER TYPE): the one-file rule. Every FOLDER/STEM.cpp must define
# `const TYPE& sphvv::ROOM::FOLDER::STEM()`; a file that does not is a link error, so none can vanish silently.
# Generates `std::span<const TYPE* const> sphvv::ROOM::FOLDER::all()`, in the order of the file names.
function(sphvv_registry room folder type out_sources)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp)
  list(SORT files)
  list(LENGTH files count)
  set(declarations "")
  set(entries "")
  foreach(file IN LISTS files)
    get_filename_component(stem ${file} NAME_WE)
    string(APPEND declarations "const ${type}& ${stem}();\n")
    string(APPEND entries "        &${stem}(),\n")
  endforeach()
  string(TOUPPER ${folder} FOLDER)
  set(generated ${PROJECT_BINARY_DIR}/generated/sphvv_${room}_${folder}.cpp)
  file(CONFIGURE OUTPUT ${generated} @ONLY CONTENT [=[
// Generated from the files of @room@/@folder@ by cmake/SphvvRoom.cmake.
#include "sphvv/@room@/@folder@.hpp"

#include <array>

namespace sphvv::@room@::@folder@ {
@declarations@
std::span<const @type@* const> all() {
    static const std::array<const @type@*, @count@> entries{
@entries@    };
    return entries;
}
} // namespace sphvv::@room@::@folder@
]=])
  set(${out_sources} ${files} ${generated} PARENT_SCOPE)
endfunction()
