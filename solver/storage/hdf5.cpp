// The macro makes later releases offer the functions of 1.10.
#define H5_USE_110_API
#include "sphvv/solver/storage/hdf5.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/storage/global_heaps.hpp"
#include "sphvv/solver/storage/text.hpp"
#include "sphvv/solver/storage/write_atomically.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <type_traits>
#include <unistd.h>
#include <utility>

namespace sphvv::solver::storage {

static_assert(std::is_same_v<Handle::Identifier, hid_t> && std::is_same_v<herr_t, int>);

Handle::Handle(Handle&& other) noexcept
    : identifier_(std::exchange(other.identifier_, -1)), close_(other.close_) {}

Handle& Handle::operator=(Handle&& other) noexcept {
    std::swap(identifier_, other.identifier_);
    std::swap(close_, other.close_);
    return *this;
}

bool Handle::close() {
    const Identifier identifier = std::exchange(identifier_, -1);
    return identifier < 0 || close_(identifier) >= 0;
}

struct OpenFile {
    std::string name;
    std::size_t bytes = 0; ///< 0 while it is being composed
    Handle handle;
    bool heaps_checked = false;
};

namespace {

/// No filter that this project or its users' tools apply shrinks data further (deflate: 1032).
constexpr std::size_t largest_compression = 1032;
constexpr hsize_t rows_per_chunk = 65536;
/// Attributes and links of a group stay in its header up to this many, where every new one costs a pass over
/// all; beyond, the library builds search trees.
constexpr unsigned largest_compact_group = 64;
constexpr hsize_t largest_compact_bytes = 60000; // the library's own limit is a header message of 65535

/// The library reports errors by its return values only; called before every use of a file.
void silence_library() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

template <class T>
Handle memory_type() {
    if constexpr (std::is_same_v<T, std::string>) {
        Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
        H5Tset_size(type.get(), H5T_VARIABLE);
        H5Tset_cset(type.get(), H5T_CSET_UTF8);
        return type;
    } else if constexpr (std::is_same_v<T, double>) {
        return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
        return {H5Tcopy(H5T_NATIVE_INT64), H5Tclose};
    } else {
        static_assert(std::is_same_v<T, std::uint8_t>);
        return {H5Tcopy(H5T_NATIVE_UINT8), H5Tclose};
    }
}

/// What the library writes for values: the values themselves, or pointers to texts.
template <class T>
struct Source {
    explicit Source(std::span<const T> values) : data(values.data()) {}
    const void* data;
};

template <>
struct Source<std::string> {
    explicit Source(std::span<const std::string> values) {
        for (const std::string& value : values) {
            texts.push_back(valid_utf8(value));
        }
        for (const std::string& text : texts) {
            pointers.push_back(text.c_str());
        }
        data = pointers.data();
    }
    std::vector<std::string> texts;
    std::vector<const char*> pointers;
    const void* data;
};

/// What groups and the root have in common: they tell in which order their members were made, but not when.
void set_group_properties(hid_t properties) {
    constexpr unsigned ordered = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
    H5Pset_link_creation_order(properties, ordered);
    H5Pset_attr_creation_order(properties, ordered);
    H5Pset_link_phase_change(properties, largest_compact_group, largest_compact_group / 2);
    H5Pset_attr_phase_change(properties, largest_compact_group, largest_compact_group / 2);
    H5Pset_obj_track_times(properties, false);
}

/// Small datasets go into the object header, which has a checksum; chunks of large ones have their own. (The
/// library has none for texts, which are references into a heap there.)
Handle dataset_properties(std::array<hsize_t, 2> extent, int rank, const Handle& type) {
    Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties.get(), false);
    if (extent[0] * extent[1] * H5Tget_size(type.get()) <= largest_compact_bytes) {
        H5Pset_layout(properties.get(), H5D_COMPACT);
    } else if (H5Tget_class(type.get()) != H5T_STRING) {
        extent[0] = std::min(extent[0], rows_per_chunk);
        H5Pset_chunk(properties.get(), rank, extent.data());
        H5Pset_fletcher32(properties.get());
    }
    return properties;
}

/// The bytes of a file that the library keeps in memory; it hands them over when the file is closed.
struct Image {
    void* data = nullptr;
    std::size_t capacity = 0;

    Image() = default;
    Image(const Image&) = delete;
    Image& operator=(const Image&) = delete;
    ~Image() { std::free(data); }

    static void* allocate(std::size_t bytes, H5FD_file_image_op_t, void* image) {
        return resize(nullptr, bytes, {}, image);
    }
    static void* resize(void* data, std::size_t bytes, H5FD_file_image_op_t, void* image) {
        void* resized = std::realloc(data, bytes);
        if (resized != nullptr) {
            static_cast<Image*>(image)->capacity = bytes;
        }
        return resized;
    }
    static herr_t release(void* data, H5FD_file_image_op_t, void* image) {
        std::free(std::exchange(static_cast<Image*>(image)->data, data));
        return 0;
    }
    static void* share(void* image) { return image; }
    static herr_t unshare(void*) { return 0; }
};

Handle access_properties() {
    Handle properties(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_libver_bounds(properties.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
    H5Pset_fclose_degree(properties.get(), H5F_CLOSE_STRONG);
    // Files appear complete under their name, so nobody needs a lock, and not every file system has them.
    H5Pset_file_locking(properties.get(), false, true);
    return properties;
}

Handle create_in_memory(const std::string& name, Image& image) {
    constexpr std::size_t increment = 1 << 16;
    const Handle access = access_properties();
    H5FD_file_image_callbacks_t callbacks{Image::allocate, nullptr,        Image::resize, Image::release,
                                          Image::share,    Image::unshare, &image};
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    set_group_properties(creation.get());
    if (H5Pset_fapl_core(access.get(), increment, false) < 0 ||
        H5Pset_file_image_callbacks(access.get(), &callbacks) < 0) {
        return {};
    }
    // The library wants a name. It would load a file that has it, so no file can.
    const std::string nowhere = "/dev/null/" + name;
    return {H5Fcreate(nowhere.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose};
}

[[noreturn]] void refuse_writing(const std::string& file, const std::string& what) {
    throw UserError(file + ": cannot be written: the HDF5 library fails at " + what);
}

/// Size of a file that can be opened and read. Throws UserError.
std::size_t readable_bytes(const std::filesystem::path& path) {
    // A pipe would wait for its writer.
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        throw UserError(path.string() +
                        (errno == ENOENT ? ": the file does not exist"
                                         : ": cannot be read: " + std::generic_category().message(errno)));
    }
    struct stat status {};
    const bool known = ::fstat(descriptor, &status) == 0;
    ::close(descriptor);
    if (!known || S_ISDIR(status.st_mode)) {
        throw UserError(path.string() + ": is a folder, where an HDF5 file is needed");
    }
    if (!S_ISREG(status.st_mode)) {
        throw UserError(path.string() + ": is not a regular file");
    }
    if (status.st_size == 0) {
        throw UserError(path.string() + ": the file is empty");
    }
    return static_cast<std::size_t>(status.st_size);
}

Kind kind_of(hid_t type) {
    switch (H5Tget_class(type)) {
    case H5T_INTEGER:
        return Kind::integer;
    case H5T_FLOAT:
        return Kind::real;
    case H5T_STRING:
        return Kind::text;
    default:
        return Kind::other;
    }
}

/// Adds a name to a list; negative, which ends the iteration, if it is not UTF-8. (No exception may pass
/// through the library; without memory the program ends.)
herr_t add_name(const char* name, void* names) noexcept {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return valid_utf8(name) == name ? 0 : -1;
}

herr_t add_link(hid_t, const char* name, const H5L_info_t*, void* names) {
    return add_name(name, names);
}

herr_t add_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
    return add_name(name, names);
}

H5_index_t order_of(hid_t group, herr_t (*get)(hid_t, unsigned*)) {
    const Handle properties(H5Gget_create_plist(group), H5Pclose);
    unsigned flags = 0;
    const bool indexed =
        properties.valid() && get(properties.get(), &flags) >= 0 && (flags & H5P_CRT_ORDER_INDEXED);
    return indexed ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

} // namespace

/// An attribute or dataset about to be read.
struct Group::Values {
    std::string_view name;
    Handle object;
    Handle type;
    Handle space;
    herr_t (*read)(hid_t object, hid_t memory_type, void* buffer);
};

Group::Group(std::shared_ptr<OpenFile> file, Handle handle, std::string place)
    : file_(std::move(file)), handle_(std::move(handle)), place_(std::move(place)) {}

void Group::refuse(const std::string& what) const {
    throw UserError(file_->name + ": " + what);
}

void Group::refuse_damaged(std::string_view name) const {
    refuse("the file is damaged (at " + place_of(name) + ")");
}

std::string Group::place_of(std::string_view name) const {
    return place_ + (place_ == "/" ? "" : "/") + valid_utf8(name);
}

// ---- composing

Group Group::create_group(std::string_view name) const {
    const Handle properties(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
    set_group_properties(properties.get());
    Handle created(
        H5Gcreate2(handle_.get(), std::string(name).c_str(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
        H5Gclose);
    if (!created.valid()) {
        refuse_writing(file_->name, place_of(name));
    }
    return {file_, std::move(created), place_of(name)};
}

template <class T>
void Group::write_attribute(std::string_view name, std::span<const T> values, bool scalar) const {
    const hsize_t count = values.size();
    const Handle type = memory_type<T>();
    const Handle space(scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
    Handle attribute(H5Acreate2(handle_.get(), std::string(name).c_str(), type.get(), space.get(),
                                H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
    if (!attribute.valid() || H5Awrite(attribute.get(), type.get(), Source<T>(values).data) < 0 ||
        !attribute.close()) {
        refuse_writing(file_->name, place_of(name));
    }
}

template <class T>
void Group::set_attribute(std::string_view name, const T& value) const {
    write_attribute(name, std::span<const T>(&value, 1), true);
}

template <class T>
void Group::set_attribute_array(std::string_view name, std::span<const T> values) const {
    write_attribute(name, values, false);
}

template <class T>
void Group::create_dataset(std::string_view name, std::span<const T> values, std::size_t columns) const {
    const int rank = columns == 1 ? 1 : 2;
    const std::array<hsize_t, 2> extent{values.size() / columns, columns};
    const Handle type = memory_type<T>();
    const Handle space(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose);
    const Handle properties = dataset_properties(extent, rank, type);
    Handle dataset(H5Dcreate2(handle_.get(), std::string(name).c_str(), type.get(), space.get(), H5P_DEFAULT,
                              properties.get(), H5P_DEFAULT),
                   H5Dclose);
    if (!dataset.valid() ||
        H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, Source<T>(values).data) < 0 ||
        !dataset.close()) {
        refuse_writing(file_->name, place_of(name));
    }
}

void write_hdf5(const std::filesystem::path& path, const std::function<void(const Group&)>& fill) {
    silence_library();
    Image image;
    auto file = std::make_shared<OpenFile>();
    file->name = path.string();
    file->handle = create_in_memory(file->name, image);
    Handle root(file->handle.valid() ? H5Gopen2(file->handle.get(), "/", H5P_DEFAULT) : -1, H5Gclose);
    if (!root.valid()) {
        refuse_writing(file->name, "making a file");
    }
    fill(Group(file, std::move(root), "/"));
    // (H5Fget_file_image would also give the bytes, but with a wrong checksum in the superblock.)
    const bool flushed = H5Fflush(file->handle.get(), H5F_SCOPE_GLOBAL) >= 0;
    const ssize_t bytes = H5Fget_file_image(file->handle.get(), nullptr, 0);
    if (!flushed || bytes <= 0 || !file->handle.close() || static_cast<std::size_t>(bytes) > image.capacity) {
        refuse_writing(file->name, "completing the file");
    }
    write_atomically(path, {static_cast<const char*>(image.data), static_cast<std::size_t>(bytes)});
}

// ---- reading

Group open_hdf5(const std::filesystem::path& path) {
    silence_library();
    auto file = std::make_shared<OpenFile>();
    file->name = path.string();
    file->bytes = readable_bytes(path);
    if (H5Fis_hdf5(path.c_str()) <= 0) {
        throw UserError(file->name + ": is not an HDF5 file");
    }
    const Handle access = access_properties();
    file->handle = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
    Handle root(file->handle.valid() ? H5Gopen2(file->handle.get(), "/", H5P_DEFAULT) : -1, H5Gclose);
    if (!root.valid()) {
        throw UserError(file->name + ": the file is truncated or damaged");
    }
    return {std::move(file), std::move(root), "/"};
}

std::vector<std::string> Group::attribute_names() const {
    std::vector<std::string> names;
    if (H5Aiterate2(handle_.get(), order_of(handle_.get(), H5Pget_attr_creation_order), H5_ITER_INC, nullptr,
                    add_attribute, &names) < 0) {
        refuse_damaged("");
    }
    return names;
}

std::vector<std::string> Group::member_names() const {
    std::vector<std::string> names;
    if (H5Literate(handle_.get(), order_of(handle_.get(), H5Pget_link_creation_order), H5_ITER_INC, nullptr,
                   add_link, &names) < 0) {
        refuse_damaged("");
    }
    return names;
}

bool Group::has_attribute(std::string_view name) const {
    return H5Aexists(handle_.get(), std::string(name).c_str()) > 0;
}

bool Group::has_member(std::string_view name) const {
    return H5Lexists(handle_.get(), std::string(name).c_str(), H5P_DEFAULT) > 0;
}

/// A group or dataset. Each has one place only: a second one, or a link, could lead a reader in circles or
/// out of the file.
Handle Group::open_member(std::string_view name) const {
    if (!has_member(name)) {
        refuse("the file has no member " + place_of(name));
    }
    H5L_info_t link{};
    if (H5Lget_info(handle_.get(), std::string(name).c_str(), &link, H5P_DEFAULT) < 0) {
        refuse_damaged(name);
    }
    if (link.type != H5L_TYPE_HARD) {
        refuse(place_of(name) + " is a link, where a group or dataset is needed");
    }
    Handle member(H5Oopen(handle_.get(), std::string(name).c_str(), H5P_DEFAULT), H5Oclose);
    H5O_info_t object{};
    if (!member.valid() || H5Oget_info2(member.get(), &object, H5O_INFO_BASIC) < 0) {
        refuse_damaged(name);
    }
    if (object.rc > 1) {
        refuse(place_of(name) + " has a second place in the file");
    }
    return member;
}

bool Group::is_group(std::string_view name) const {
    return H5Iget_type(open_member(name).get()) == H5I_GROUP;
}

Group Group::group(std::string_view name) const {
    Handle member = open_member(name);
    if (H5Iget_type(member.get()) != H5I_GROUP) {
        refuse(place_of(name) + " is not a group");
    }
    return {file_, std::move(member), place_of(name)};
}

Group::Values Group::open_attribute(std::string_view name) const {
    if (!has_attribute(name)) {
        refuse("the file has no attribute " + place_of(name));
    }
    Values values{name,
                  Handle(H5Aopen(handle_.get(), std::string(name).c_str(), H5P_DEFAULT), H5Aclose),
                  {},
                  {},
                  H5Aread};
    if (values.object.valid()) {
        values.type = Handle(H5Aget_type(values.object.get()), H5Tclose);
        values.space = Handle(H5Aget_space(values.object.get()), H5Sclose);
    }
    if (!values.type.valid() || !values.space.valid()) {
        refuse_damaged(name);
    }
    return values;
}

Group::Values Group::open_dataset(std::string_view name) const {
    Values values{name, open_member(name), {}, {}, nullptr};
    if (H5Iget_type(values.object.get()) != H5I_DATASET) {
        refuse(place_of(name) + " is not a dataset");
    }
    values.type = Handle(H5Dget_type(values.object.get()), H5Tclose);
    values.space = Handle(H5Dget_space(values.object.get()), H5Sclose);
    if (!values.type.valid() || !values.space.valid()) {
        refuse_damaged(name);
    }
    values.read = [](hid_t dataset, hid_t type, void* buffer) {
        return H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
    };
    return values;
}

Kind Group::attribute_kind(std::string_view name) const {
    return kind_of(open_attribute(name).type.get());
}

Extent Group::extent(std::string_view name) const {
    const Values values = open_dataset(name);
    const int rank = H5Sget_simple_extent_ndims(values.space.get());
    if (rank != 1 && rank != 2) {
        refuse(place_of(name) + " has neither one dimension nor two");
    }
    std::array<hsize_t, 2> extent{0, 1};
    if (H5Sget_simple_extent_dims(values.space.get(), extent.data(), nullptr) < 0) {
        refuse_damaged(name);
    }
    return {kind_of(values.type.get()), extent[0], extent[1]};
}

/// Number of values, if the file can hold as many.
std::size_t Group::count(const Values& values) const {
    const hssize_t count = H5Sget_simple_extent_npoints(values.space.get());
    const std::size_t largest =
        file_->bytes * largest_compression / std::max<std::size_t>(1, H5Tget_size(values.type.get()));
    if (count < 0 || static_cast<std::size_t>(count) > largest) {
        refuse_damaged(values.name);
    }
    return static_cast<std::size_t>(count);
}

template <class T>
std::vector<T> Group::read(const Values& values) const {
    const Kind kind = kind_of(values.type.get());
    constexpr bool real = std::is_same_v<T, double>;
    if (kind != Kind::integer && !(real && kind == Kind::real)) {
        refuse(place_of(values.name) + (real ? " is not a number" : " is not an integer"));
    }
    std::vector<T> result(count(values));
    if (!result.empty() && values.read(values.object.get(), memory_type<T>().get(), result.data()) < 0) {
        refuse_damaged(values.name);
    }
    return result;
}

template <>
std::vector<std::string> Group::read(const Values& values) const {
    if (kind_of(values.type.get()) != Kind::text) {
        refuse(place_of(values.name) + " is not a text");
    }
    const std::size_t texts = count(values);
    return H5Tis_variable_str(values.type.get()) > 0 ? read_variable_texts(values, texts)
                                                     : read_fixed_texts(values, texts);
}

std::vector<std::string> Group::read_variable_texts(const Values& values, std::size_t texts) const {
    if (!file_->heaps_checked && !are_global_heaps_sound(file_->name)) {
        refuse_damaged(values.name);
    }
    file_->heaps_checked = true;
    const Handle type = memory_type<std::string>();
    H5Tset_cset(type.get(), H5Tget_cset(values.type.get()));
    std::vector<char*> pointers(texts, nullptr);
    const bool sound = texts == 0 || values.read(values.object.get(), type.get(), pointers.data()) >= 0;
    std::vector<std::string> result(texts);
    std::transform(pointers.begin(), pointers.end(), result.begin(), [](const char* pointer) {
        return pointer == nullptr ? std::string() : valid_utf8(pointer);
    });
    H5Dvlen_reclaim(type.get(), values.space.get(), H5P_DEFAULT, pointers.data());
    if (!sound) {
        refuse_damaged(values.name);
    }
    return result;
}

std::vector<std::string> Group::read_fixed_texts(const Values& values, std::size_t texts) const {
    const std::size_t length = H5Tget_size(values.type.get());
    const bool padded = H5Tget_strpad(values.type.get()) == H5T_STR_SPACEPAD;
    std::string buffer(texts * length, '\0');
    if (texts > 0 && values.read(values.object.get(), values.type.get(), buffer.data()) < 0) {
        refuse_damaged(values.name);
    }
    std::vector<std::string> result;
    for (std::size_t k = 0; k < texts; ++k) {
        std::string_view text = std::string_view(buffer).substr(k * length, length);
        text = text.substr(0, text.find('\0'));
        result.push_back(valid_utf8(padded ? text.substr(0, text.find_last_not_of(' ') + 1) : text));
    }
    return result;
}

template <class T>
std::vector<T> Group::attribute_array(std::string_view name) const {
    return read<T>(open_attribute(name));
}

template <class T>
T Group::attribute(std::string_view name) const {
    std::vector<T> values = attribute_array<T>(name);
    if (values.size() != 1) {
        refuse(place_of(name) + " is not a single value");
    }
    return std::move(values.front());
}

template <class T>
std::vector<T> Group::dataset(std::string_view name) const {
    return read<T>(open_dataset(name));
}

#define SPHVV_INSTANTIATE(T)                                                                                 \
    template void Group::set_attribute(std::string_view, const T&) const;                                    \
    template void Group::set_attribute_array(std::string_view, std::span<const T>) const;                    \
    template void Group::create_dataset(std::string_view, std::span<const T>, std::size_t) const;            \
    template T Group::attribute(std::string_view) const;                                                     \
    template std::vector<T> Group::attribute_array(std::string_view) const;                                  \
    template std::vector<T> Group::dataset(std::string_view) const;
SPHVV_INSTANTIATE(std::string)
SPHVV_INSTANTIATE(double)
SPHVV_INSTANTIATE(std::int64_t)
SPHVV_INSTANTIATE(std::uint8_t)
#undef SPHVV_INSTANTIATE

} // namespace sphvv::solver::storage
