#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

namespace sphvv::verification {

/// The content of a result file: what stands in its JSON form, member by member (reports/FORMAT.md).
using ResultTree = nlohmann::ordered_json;

/// Writes a tree as HDF5, by the mapping of reports/FORMAT.md; the file appears complete or not at all.
///
/// Where that mapping leaves a choice: not-a-number is null; an array of objects whose columns cannot be told
/// from the stored values alone (numbers mixed with texts, booleans with null, integers that a double beside
/// them would round) is not a table but a list of items. Throws UserError if the file cannot be written, and
/// std::invalid_argument, naming the member, for what the mapping has no place for: arrays in arrays or of
/// mixed kinds, integers beyond 64 bits with sign, reserved or unusable names.
void write_results_hdf5(const ResultTree& tree, const std::filesystem::path& path);

/// Reads the tree of a file. Members keep the order in which they were written, scalars before arrays and
/// objects; null members are gone, and so is the difference between null and "" in a column of texts.
///
/// Throws UserError, one sentence, if the file does not exist, is not HDF5, is not a result file or one of a
/// newer version, or is truncated or damaged.
ResultTree read_results_hdf5(const std::filesystem::path& path);

/// Throws UserError, naming the file and the first member that is missing or wrong, unless the tree has all
/// that reports/FORMAT.md says a result file has.
void check_result_file(const ResultTree& tree, const std::filesystem::path& path);

} // namespace sphvv::verification
