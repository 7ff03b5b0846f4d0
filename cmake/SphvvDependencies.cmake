# Every library the project stands on; README.md gives the reason for each.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(GSL REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(benchmark REQUIRED)
find_package(GTest REQUIRED)
find_package(Threads REQUIRED)

# The report needs the Python that owns Debian's matplotlib; the first python3 on a PATH may be another one.
set(SPHVV_PYTHON_MODULES "import h5py, jinja2, matplotlib")
function(sphvv_python_has_modules result candidate)
  execute_process(COMMAND ${candidate} -c "${SPHVV_PYTHON_MODULES}" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(NOT status EQUAL 0)
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()
find_program(SPHVV_PYTHON NAMES python3 HINTS /usr/bin NO_CMAKE_PATH VALIDATOR sphvv_python_has_modules REQUIRED
             DOC "A python3 with h5py, Jinja2 and matplotlib")
