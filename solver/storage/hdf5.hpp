#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// HDF5 files as a tree of groups, attributes and datasets.
///
/// Files are composed in memory and put in place by write_atomically(), so that nothing of the HDF5 library
/// can fail half-way through a file. Metadata and datasets carry checksums (file format of HDF5 1.10,
/// Fletcher-32), and no time of writing: the same content gives the same bytes. Text is UTF-8; bytes that are
/// not become U+FFFD.
///
/// Errors of the file are a UserError, one sentence that names it. The library is not used from two threads
/// at once.
namespace sphvv::solver::storage {

/// What a stored value is; `other` is nothing that this project writes.
enum class Kind { integer, real, text, other };

/// Of a dataset; one column if it is one-dimensional.
struct Extent {
    Kind kind;
    std::size_t rows;
    std::size_t columns;
};

/// Owns an HDF5 identifier.
class Handle {
public:
    using Identifier = std::int64_t; // hid_t
    using Close = int (*)(Identifier);

    Handle() = default;
    Handle(Identifier identifier, Close close_with) : identifier_(identifier), close_(close_with) {}
    Handle(Handle&& other) noexcept;
    Handle& operator=(Handle&& other) noexcept;
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() { close(); }

    Identifier get() const { return identifier_; }
    bool valid() const { return identifier_ >= 0; }
    /// Closes now; false if the library reports an error.
    bool close();

private:
    Identifier identifier_ = -1;
    Close close_ = nullptr;
};

struct OpenFile;

/// A group of an open file; the file stays open as long as any of its groups.
///
/// Values are std::string, double, std::int64_t or std::uint8_t. Reading throws UserError for a member that
/// is missing, of another kind, reached by a link, or damaged.
class Group {
public:
    Group(std::shared_ptr<OpenFile> file, Handle handle, std::string place);

    Group create_group(std::string_view name) const;
    template <class T>
    void set_attribute(std::string_view name, const T& value) const;
    template <class T>
    void set_attribute_array(std::string_view name, std::span<const T> values) const;
    /// One-dimensional, or rows × columns with the entries of a row side by side.
    template <class T>
    void create_dataset(std::string_view name, std::span<const T> values, std::size_t columns = 1) const;

    /// In the order in which they were made if the file tells, else by name.
    std::vector<std::string> attribute_names() const;
    /// Groups and datasets.
    std::vector<std::string> member_names() const;
    bool has_attribute(std::string_view name) const;
    bool has_member(std::string_view name) const;
    bool is_group(std::string_view name) const;
    Kind attribute_kind(std::string_view name) const;
    Extent extent(std::string_view name) const;

    Group group(std::string_view name) const;
    /// A scalar. An integer is read as a double where one is asked for.
    template <class T>
    T attribute(std::string_view name) const;
    /// A scalar or an array.
    template <class T>
    std::vector<T> attribute_array(std::string_view name) const;
    template <class T>
    std::vector<T> dataset(std::string_view name) const;

    /// The path within the file.
    const std::string& place() const { return place_; }
    /// Throws UserError: the file's name, then `what`.
    [[noreturn]] void refuse(const std::string& what) const;

private:
    struct Values;

    [[noreturn]] void refuse_damaged(std::string_view name) const;
    std::string place_of(std::string_view name) const;
    template <class T>
    void write_attribute(std::string_view name, std::span<const T> values, bool scalar) const;
    Handle open_member(std::string_view name) const;
    Values open_attribute(std::string_view name) const;
    Values open_dataset(std::string_view name) const;
    std::size_t count(const Values& values) const;
    template <class T>
    std::vector<T> read(const Values& values) const;
    std::vector<std::string> read_variable_texts(const Values& values, std::size_t texts) const;
    std::vector<std::string> read_fixed_texts(const Values& values, std::size_t texts) const;

    std::shared_ptr<OpenFile> file_;
    Handle handle_;
    std::string place_;
};

/// Writes the file that `fill` composes; it is given the root.
void write_hdf5(const std::filesystem::path& path, const std::function<void(const Group&)>& fill);

/// Opens a file for reading and returns its root. Throws UserError if it does not exist, cannot be read, is
/// not an HDF5 file, or is truncated or damaged.
Group open_hdf5(const std::filesystem::path& path);

} // namespace sphvv::solver::storage
