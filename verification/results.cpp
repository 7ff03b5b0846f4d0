#include "sphvv/verification/results.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/storage/hdf5.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sphvv::verification {
namespace {

using solver::storage::Group;
using solver::storage::Kind;

constexpr std::string_view format_name = "sphvv-results";
constexpr std::int64_t format_version = 1;
constexpr int deepest = 32; // levels of groups; the reader of the report has the same limit
constexpr const char* list_attribute = "_list";
constexpr const char* flags_attribute = "_booleans";

// ---- writing

bool is_null(const ResultTree& value) {
    return value.is_null() || (value.is_number_float() && std::isnan(value.get<double>()));
}

bool is_flat(const ResultTree& value) {
    return !value.is_structured();
}

/// How the values of an array or a column are stored together.
enum class Column { integers, reals, flags, texts, none };

/// `none` if the values have no common kind that tells them all apart.
Column column_of(const std::vector<const ResultTree*>& values) {
    const auto all = [&](auto&& predicate) {
        return std::all_of(values.begin(), values.end(),
                           [&](const ResultTree* value) { return predicate(*value); });
    };
    const auto survives_as_real = [](const ResultTree& value) {
        constexpr std::int64_t exact = std::int64_t{1} << std::numeric_limits<double>::digits;
        return value.is_number_float() || is_null(value) ||
               (value.is_number() && std::abs(value.get<std::int64_t>()) <= exact);
    };
    if (all([](const ResultTree& value) { return value.is_number_integer(); })) {
        return Column::integers;
    }
    if (all([](const ResultTree& value) { return value.is_boolean(); })) {
        return Column::flags;
    }
    if (all(survives_as_real)) {
        return Column::reals;
    }
    const bool texts = all([](const ResultTree& value) { return value.is_string() || value.is_null(); });
    return texts ? Column::texts : Column::none;
}

std::string member_of(const Group& group, const std::string& name) {
    return group.place() + (group.place() == "/" ? "" : "/") + name;
}

[[noreturn]] void reject(const std::string& member, const std::string& why) {
    throw std::invalid_argument("a result file cannot hold " + member + ": " + why);
}

std::int64_t integer(const ResultTree& value, const std::string& member) {
    if (value.is_number_unsigned() && value.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max()) {
        reject(member, value.dump() + " is beyond 64 bits with sign");
    }
    return value.get<std::int64_t>();
}

double real(const ResultTree& value) {
    return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

/// Name of an attribute; members that are groups or datasets cannot have '/' in it.
void check_name(const Group& group, const std::string& name, bool attribute) {
    const bool reserved = name == list_attribute || name == flags_attribute;
    const bool unusable = name.empty() || name.find('\0') != std::string::npos ||
                          (!attribute && (name == "." || name.find('/') != std::string::npos));
    if (reserved || unusable) {
        reject(member_of(group, name), reserved ? "the name is reserved" : "the name cannot be one of HDF5");
    }
}

void write_values(const Group& group, const std::string& name, const std::vector<const ResultTree*>& values,
                  Column column) {
    const auto write = [&]<class T>(auto&& convert) {
        std::vector<T> converted(values.size());
        std::transform(values.begin(), values.end(), converted.begin(),
                       [&](const ResultTree* value) { return static_cast<T>(convert(*value)); });
        group.create_dataset(name, std::span<const T>(converted));
    };
    check_name(group, name, false);
    switch (column) {
    case Column::integers:
        return write.operator()<std::int64_t>(
            [&](const ResultTree& v) { return integer(v, member_of(group, name)); });
    case Column::reals:
        return write.operator()<double>(real);
    case Column::flags:
        return write.operator()<std::uint8_t>([](const ResultTree& v) { return v.get<bool>() ? 1 : 0; });
    case Column::texts:
        return write.operator()<std::string>(
            [](const ResultTree& v) { return v.is_null() ? std::string() : v.get<std::string>(); });
    case Column::none:
        reject(member_of(group, name), "its entries are neither all numbers nor all texts");
    }
}

std::vector<const ResultTree*> column(const ResultTree& rows, const std::string& key) {
    std::vector<const ResultTree*> values;
    for (const ResultTree& row : rows) {
        values.push_back(&row.at(key));
    }
    return values;
}

/// Objects with the same keys, whose values can be stored column by column and told apart again.
bool is_table(const ResultTree& rows) {
    const ResultTree& first = rows.front();
    const bool same_keys = std::all_of(rows.begin(), rows.end(), [&](const ResultTree& row) {
        return row.size() == first.size() &&
               std::all_of(row.items().begin(), row.items().end(), [&](const auto& item) {
                   return first.contains(item.key()) && is_flat(item.value());
               });
    });
    return same_keys && !first.empty() &&
           std::all_of(first.items().begin(), first.items().end(),
                       [&](const auto& item) { return column_of(column(rows, item.key())) != Column::none; });
}

void write_flag_names(const Group& group, const std::vector<std::string>& flags) {
    if (!flags.empty()) {
        group.set_attribute_array(flags_attribute, std::span<const std::string>(flags));
    }
}

void write_table(const Group& group, const ResultTree& rows) {
    std::vector<std::string> flags;
    for (const auto& [key, unused] : rows.front().items()) {
        const std::vector<const ResultTree*> values = column(rows, key);
        const Column kind = column_of(values);
        write_values(group, key, values, kind);
        if (kind == Column::flags) {
            flags.push_back(key);
        }
    }
    write_flag_names(group, flags);
}

void write_object(const Group& group, const ResultTree& object);

/// Names that sort in the order of the entries.
std::string item_name(std::size_t index, std::size_t count) {
    const std::string number = std::to_string(index);
    const std::size_t width = std::max<std::size_t>(4, std::to_string(count - 1).size());
    return std::string(width - number.size(), '0') + number;
}

void write_array(const Group& parent, const std::string& name, const ResultTree& array) {
    const auto make_list = [&](const std::string& kind) {
        check_name(parent, name, false);
        Group group = parent.create_group(name);
        group.set_attribute<std::string>(list_attribute, kind);
        return group;
    };
    if (array.empty()) {
        make_list("empty");
        return;
    }
    if (std::none_of(array.begin(), array.end(), [](const ResultTree& entry) { return entry.is_object(); })) {
        std::vector<const ResultTree*> values;
        for (const ResultTree& entry : array) {
            values.push_back(&entry);
        }
        const Column kind = column_of(values);
        return write_values(parent, name, values, kind == Column::flags ? Column::none : kind);
    }
    if (!std::all_of(array.begin(), array.end(), [](const ResultTree& entry) { return entry.is_object(); })) {
        reject(member_of(parent, name), "only some of its entries are objects");
    }
    if (is_table(array)) {
        return write_table(make_list("table"), array);
    }
    const Group items = make_list("items");
    for (std::size_t k = 0; k < array.size(); ++k) {
        write_object(items.create_group(item_name(k, array.size())), array[k]);
    }
}

void write_scalar(const Group& group, const std::string& name, const ResultTree& value) {
    check_name(group, name, true);
    if (value.is_boolean()) {
        group.set_attribute<std::uint8_t>(name, value.get<bool>() ? 1 : 0);
    } else if (value.is_number_integer()) {
        group.set_attribute<std::int64_t>(name, integer(value, member_of(group, name)));
    } else if (value.is_number_float()) {
        group.set_attribute<double>(name, value.get<double>());
    } else {
        group.set_attribute<std::string>(name, value.get<std::string>());
    }
}

void write_object(const Group& group, const ResultTree& object) {
    std::vector<std::string> flags;
    for (const auto& [name, value] : object.items()) {
        if (is_null(value)) {
            continue;
        }
        if (value.is_object()) {
            check_name(group, name, false);
            write_object(group.create_group(name), value);
        } else if (value.is_array()) {
            write_array(group, name, value);
        } else {
            write_scalar(group, name, value);
        }
        if (value.is_boolean()) {
            flags.push_back(name);
        }
    }
    write_flag_names(group, flags);
}

// ---- reading

std::set<std::string> read_flag_names(const Group& group) {
    if (!group.has_attribute(flags_attribute)) {
        return {};
    }
    const std::vector<std::string> names = group.attribute_array<std::string>(flags_attribute);
    return {names.begin(), names.end()};
}

ResultTree from_real(double value) {
    return std::isnan(value) ? ResultTree() : ResultTree(value);
}

/// The entries of a one-dimensional dataset.
std::vector<ResultTree> read_values(const Group& group, const std::string& name, bool flags) {
    const solver::storage::Extent extent = group.extent(name);
    std::vector<ResultTree> values;
    if (extent.columns != 1) {
        group.refuse(member_of(group, name) + " has more than one dimension");
    }
    switch (extent.kind) {
    case Kind::integer:
        for (const std::int64_t value : group.dataset<std::int64_t>(name)) {
            values.push_back(flags ? ResultTree(value != 0) : ResultTree(value));
        }
        break;
    case Kind::real:
        for (const double value : group.dataset<double>(name)) {
            values.push_back(from_real(value));
        }
        break;
    case Kind::text:
        for (std::string& value : group.dataset<std::string>(name)) {
            values.emplace_back(std::move(value));
        }
        break;
    case Kind::other:
        group.refuse(member_of(group, name) + " is neither numbers nor texts");
    }
    return values;
}

ResultTree read_table(const Group& group) {
    const std::set<std::string> flags = read_flag_names(group);
    const std::vector<std::string> names = group.member_names();
    const std::size_t count = names.empty() ? 0 : group.extent(names.front()).rows;
    ResultTree rows = ResultTree(count, ResultTree::object());
    for (const std::string& name : names) {
        std::vector<ResultTree> values = read_values(group, name, flags.contains(name));
        if (values.size() != rows.size()) {
            group.refuse("the columns of " + group.place() + " differ in length");
        }
        for (std::size_t k = 0; k < values.size(); ++k) {
            rows[k][name] = std::move(values[k]);
        }
    }
    return rows;
}

ResultTree read_group(const Group& group, int depth);

ResultTree read_items(const Group& group, int depth) {
    std::vector<std::string> names = group.member_names();
    std::sort(names.begin(), names.end());
    ResultTree items = ResultTree::array();
    for (const std::string& name : names) {
        items.push_back(read_group(group.group(name), depth + 1));
    }
    return items;
}

ResultTree read_scalar(const Group& group, const std::string& name, bool flag) {
    switch (group.attribute_kind(name)) {
    case Kind::integer: {
        const auto value = group.attribute<std::int64_t>(name);
        return flag ? ResultTree(value != 0) : ResultTree(value);
    }
    case Kind::real:
        return from_real(group.attribute<double>(name));
    case Kind::text:
        return group.attribute<std::string>(name);
    case Kind::other:
        break;
    }
    group.refuse(member_of(group, name) + " is neither a number nor a text");
}

ResultTree read_object(const Group& group, int depth) {
    const std::set<std::string> flags = read_flag_names(group);
    ResultTree object = ResultTree::object();
    for (const std::string& name : group.attribute_names()) {
        if (name == flags_attribute) {
            continue;
        }
        ResultTree value = read_scalar(group, name, flags.contains(name));
        if (!value.is_null()) {
            object[name] = std::move(value);
        }
    }
    for (const std::string& name : group.member_names()) {
        object[name] = group.is_group(name) ? read_group(group.group(name), depth + 1)
                                            : ResultTree(read_values(group, name, false));
    }
    return object;
}

ResultTree read_group(const Group& group, int depth) {
    if (depth > deepest) {
        group.refuse("it nests deeper than " + std::to_string(deepest) + " levels");
    }
    if (!group.has_attribute(list_attribute)) {
        return read_object(group, depth);
    }
    const auto kind = group.attribute<std::string>(list_attribute);
    if (kind == "empty") {
        return ResultTree::array();
    }
    if (kind == "table") {
        return read_table(group);
    }
    if (kind == "items") {
        return read_items(group, depth);
    }
    group.refuse(group.place() + " is a list of unknown kind '" + kind + "'");
}

// ---- checking

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
    throw UserError(path.string() + ": " + what);
}

[[noreturn]] void refuse_incomplete(const std::filesystem::path& path, const std::string& fault) {
    refuse(path, "not a complete result file: " + fault);
}

/// Refuses what another program, or a newer one of ours, has written.
void check_format(const ResultTree& name, const ResultTree& version, const std::filesystem::path& path) {
    if (name != format_name) {
        refuse(path, "not a result file of sphvv (its member 'format' is not \"" + std::string(format_name) +
                         "\")");
    }
    if (!version.is_number_integer() || version < 1) {
        refuse(path, "its format_version is not a version that ever was (this sphvv reads 1 to " +
                         std::to_string(format_version) + ")");
    }
    if (version > format_version) {
        refuse(path, "written by a newer sphvv (format version " + version.dump() +
                         "; this one reads up to " + std::to_string(format_version) + ")");
    }
}

/// Members that a kind of object has; with '?' those that may be missing. An object is named by the way to
/// it.
struct Members {
    std::string_view of;
    std::string_view kind; // "a text", …; see is_kind
    std::string_view names;
};

constexpr std::array<Members, 36> members{{
    {"", "a text", "command"},
    {"", "an object", "provenance"},
    {"", "a list", "cases studies runs fronts"},
    {"provenance", "a text", "version revision compiler? flags? build_type? cpu? started?"},
    {"provenance", "a number", "threads? seconds?"},
    {"provenance", "a boolean", "tree_clean interrupted?"},
    {"provenance", "an object", "libraries?"},
    {"cases[]", "a text", "name summary? equations? source? domain?"},
    {"cases[]", "a number", "dimension? reference_length?"},
    {"cases[]", "a list", "parameters?"},
    {"studies[]", "a text", "case group scheme field tier? axis?"},
    {"studies[]", "a number", "round_off?"},
    {"studies[]", "an object", "settings? expected? fit"},
    {"studies[]", "a list", "samples"},
    {"studies[].expected", "a number", "low? high?"},
    {"studies[].expected", "a text", "text? source? fate?"},
    {"studies[].fit", "a text", "verdict norm? reason? waiver?"},
    {"studies[].fit", "a number", "order? ci95?"},
    {"studies[].fit", "an array of numbers", "order_l1? order_l2? order_linf?"},
    {"studies[].samples[]", "a number",
     "n h dx particles dt steps l1 l2 linf l1_abs l2_abs linf_abs l2_spread seeds seconds seconds_spread "
     "repeats "
     "cpu_seconds pair_evaluations solver_iterations matrix_entries particle_steps"},
    {"studies[].samples[]", "a boolean", "relative survived"},
    {"studies[].samples[]", "a text", "diagnosis"},
    {"runs[]", "a text", "case group scheme diagnosis?"},
    {"runs[]", "a number",
     "n seed? end_time? setup_seconds? bytes_per_particle? neighbour_bytes_per_particle? "
     "pair_bytes_per_particle? energy_error? minimum_spacing?"},
    {"runs[]", "a boolean", "survived"},
    {"runs[]", "a list", "stages fields"},
    {"runs[]", "an object", "settings? budget?"},
    {"runs[].budget", "a number",
     "momentum_drift? kinetic_energy_start? kinetic_energy_end? elastic_energy_start? elastic_energy_end? "
     "energy_drift? internal_torque?"},
    {"runs[].budget", "a text", "claims? lost?"},
    {"fronts[]", "a text", "group field norm cost"},
    {"fronts[]", "a list", "curves rows"},
    {"fronts[].curves[]", "a text", "scheme"},
    {"fronts[].curves[]", "an array of numbers", "n error cost"},
    {"fronts[].rows[]", "a text", "scheme than"},
    {"fronts[].rows[]", "a boolean", "on_front"},
    {"fronts[].rows[]", "a number", "slower_by at_error"},
}};

bool is_kind(const ResultTree& value, std::string_view kind) {
    if (kind == "an array of numbers") {
        return value.is_array() && std::all_of(value.begin(), value.end(), [](const ResultTree& entry) {
                   return entry.is_number() || entry.is_null();
               });
    }
    return kind == "a text"      ? value.is_string()
           : kind == "a number"  ? value.is_number()
           : kind == "a boolean" ? value.is_boolean()
           : kind == "a list"    ? value.is_array()
                                 : value.is_object();
}

/// Calls act(object, where) for every object that lies on a way; one that does not exist is passed over.
template <class Act>
void for_each_object(const ResultTree& tree, std::string_view way, const std::string& where, Act&& act) {
    if (way.empty()) {
        act(tree, where);
        return;
    }
    const std::string_view step = way.substr(0, way.find('.'));
    const std::string_view rest = way.substr(std::min(way.size(), step.size() + 1));
    const bool list = step.ends_with("[]");
    const std::string name(step.substr(0, step.size() - (list ? 2 : 0)));
    const std::string place = where.empty() ? name : where + "." + name;
    if (!tree.is_object() || !tree.contains(name)) {
        return;
    }
    const ResultTree& member = tree.at(name);
    if (!list && !member.is_null()) {
        for_each_object(member, rest, place, act);
    }
    for (std::size_t k = 0; list && k < member.size(); ++k) {
        for_each_object(member.at(k), rest, place + "[" + std::to_string(k) + "]", act);
    }
}

/// Empty, or what is wrong with a member of an object that stands at `where`.
std::string fault_of(const ResultTree& object, const std::string& where, std::string_view name,
                     std::string_view kind, bool optional) {
    const std::string member = (where.empty() ? "" : where + ".") + std::string(name);
    if (!object.is_object()) {
        return (where.empty() ? "the root" : where) + " is not an object";
    }
    if (!object.contains(name)) {
        return optional ? "" : member + " is missing";
    }
    const ResultTree& value = object.at(std::string(name));
    // Entries of a table may be null.
    const bool may_be_null = optional || kind == "a number" || kind == "a text";
    return is_kind(value, kind) || (value.is_null() && may_be_null) ? ""
                                                                    : member + " is not " + std::string(kind);
}

void check_members(const ResultTree& tree, const std::filesystem::path& path) {
    for (const Members& row : members) {
        for_each_object(tree, row.of, "", [&](const ResultTree& object, const std::string& where) {
            for (std::string_view rest = row.names; !rest.empty();) {
                std::string_view name = rest.substr(0, rest.find(' '));
                rest.remove_prefix(std::min(rest.size(), name.size() + 1));
                const bool optional = name.ends_with('?');
                name.remove_suffix(optional ? 1 : 0);
                const std::string fault = fault_of(object, where, name, row.kind, optional);
                if (!fault.empty()) {
                    refuse_incomplete(path, fault);
                }
            }
        });
    }
}

/// What kinds of members cannot say.
void check_agreement(const ResultTree& tree, const std::filesystem::path& path) {
    const auto fail = [&](const std::string& what) { refuse_incomplete(path, what); };
    for_each_object(tree, "studies[]", "", [&](const ResultTree& study, const std::string& where) {
        const ResultTree& fit = study.at("fit");
        constexpr std::array known{"PASS", "FAIL", "INCONCLUSIVE", "NONE"};
        if (std::find(known.begin(), known.end(), fit.at("verdict")) == known.end()) {
            fail(where + ".fit.verdict is " + fit.at("verdict").dump() +
                 ", not one of PASS, FAIL, INCONCLUSIVE, NONE");
        }
        for (const char* orders : {"order_l1", "order_l2", "order_linf"}) {
            const std::size_t count = fit.contains(orders) ? fit.at(orders).size() : 0;
            if (count > 0 && count != study.at("samples").size()) {
                fail(where + ".fit." + orders + " has " + std::to_string(count) + " entries for " +
                     std::to_string(study.at("samples").size()) + " rungs");
            }
        }
    });
    for_each_object(tree, "fronts[].curves[]", "", [&](const ResultTree& curve, const std::string& where) {
        if (curve.at("n").size() != curve.at("error").size() ||
            curve.at("n").size() != curve.at("cost").size()) {
            fail(where + ": n, error and cost differ in length");
        }
    });
}

} // namespace

void write_results_hdf5(const ResultTree& tree, const std::filesystem::path& path) {
    if (!tree.is_object()) {
        reject("/", "the root is not an object");
    }
    solver::storage::write_hdf5(path, [&](const Group& root) { write_object(root, tree); });
}

ResultTree read_results_hdf5(const std::filesystem::path& path) {
    const Group root = solver::storage::open_hdf5(path);
    const auto attribute = [&](const std::string& name) {
        return root.has_attribute(name) ? read_scalar(root, name, false) : ResultTree();
    };
    check_format(attribute("format"), attribute("format_version"), path);
    return read_group(root, 0);
}

void check_result_file(const ResultTree& tree, const std::filesystem::path& path) {
    const auto member = [&](const char* name) {
        return tree.is_object() && tree.contains(name) ? tree.at(name) : ResultTree();
    };
    check_format(member("format"), member("format_version"), path);
    check_members(tree, path);
    check_agreement(tree, path);
}

} // namespace sphvv::verification
