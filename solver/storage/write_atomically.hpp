#pragma once

#include <filesystem>
#include <string_view>

namespace sphvv::solver::storage {

/// Makes `path` a file with this content, or leaves everything as it was.
///
/// The content goes to a temporary file in the same folder, is brought to the disk (fsync) and takes the name
/// in one act (rename), so that a reader sees the old file or the new one, whatever happens in between. A
/// symbolic link is followed; the permissions of an existing file are kept. Throws UserError naming the file
/// and the cause: no such folder, no permission, disk full, the name belongs to a folder or a device, …
void write_atomically(const std::filesystem::path& path, std::string_view content);

} // namespace sphvv::solver::storage
