#include "sphvv/verification/results.hpp"

#include "sphvv/solver/error.hpp"
#include "sphvv/solver/storage/hdf5.hpp"
#include "sphvv/solver/tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>

namespace {

using namespace sphvv::verification;
using sphvv::UserError;
using sphvv::solver::storage::Group;
using sphvv::solver::storage::open_hdf5;
using sphvv::solver::storage::write_hdf5;
using sphvv::tests::content;
using sphvv::tests::expect_mentions;
using sphvv::tests::put;
using sphvv::tests::refusal;
namespace fs = std::filesystem;

#ifndef SPHVV_DAMAGE_TRIALS
#define SPHVV_DAMAGE_TRIALS 500 // with -DSPHVV_DAMAGE_TRIALS=100000 for a long search
#endif

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

class Results : public sphvv::tests::TemporaryFolder {
protected:
    ResultTree round_trip(const ResultTree& tree) const {
        write_results_hdf5(tree, path);
        return read_results_hdf5(path);
    }

    const fs::path path = folder / "r.h5";
};

/// Text that differs with any value, any kind of number, and any order of array entries, but not with the
/// order of an object's members.
std::string canonical(const ResultTree& tree) {
    return nlohmann::json::parse(tree.dump()).dump();
}

ResultTree with_header(const ResultTree& members) {
    ResultTree tree{{"format", "sphvv-results"}, {"format_version", 1}};
    tree.update(members);
    return tree;
}

/// A small tree with all that FORMAT.md asks for.
ResultTree complete() {
    const auto sample = [](int n, const ResultTree& error, const char* diagnosis) {
        ResultTree row{{"n", n},     {"h", 1.3 / n}, {"dx", 1.0 / n}, {"particles", n * n},
                       {"dt", 1e-3}, {"steps", 100}};
        for (const char* name : {"l1", "l2", "linf", "l1_abs", "l2_abs", "linf_abs"}) {
            row[name] = error;
        }
        row.update(ResultTree{{"relative", true},
                              {"l2_spread", nullptr},
                              {"seeds", 1},
                              {"seconds", 0.5},
                              {"seconds_spread", 0.03},
                              {"repeats", 3},
                              {"cpu_seconds", 0.9},
                              {"pair_evaluations", 123456789012},
                              {"solver_iterations", 0},
                              {"matrix_entries", 0},
                              {"particle_steps", 100 * n * n},
                              {"survived", !error.is_null()},
                              {"diagnosis", diagnosis}});
        return row;
    };
    ResultTree members = ResultTree::parse(R"({
        "command": "sphvv verify taylor_green",
        "provenance": {"version": "0.1.0", "revision": "4f1c", "tree_clean": false, "threads": 2, "seconds": 41.7,
                       "libraries": {"nlohmann/json": "3.11.2", "HDF5": "1.10.8"}, "started": "2025-11-22T15:40:12Z"},
        "cases": [{"name": "taylor_green", "equations": "∂u/∂t = −∇p/ρ + ν ∇²u", "dimension": 2,
                   "parameters": [{"name": "re", "value": 100.0, "unit": "1"}, {"name": "flow", "value": "decaying"}]}],
        "studies": [{"case": "taylor_green", "group": "taylor_green re=100", "scheme": "wcsph", "field": "velocity",
                     "settings": {"re": 100.0, "shifting": false}, "expected": {"low": 1.0, "source": "Xu 2009"},
                     "fit": {"norm": "l2", "order": 1.5, "ci95": 0.2, "verdict": "PASS", "order_l2": [null, 1.4, 1.6]}}],
        "runs": [{"case": "taylor_green", "group": "taylor_green re=100", "scheme": "wcsph", "n": 20, "survived": true,
                  "budget": {"momentum_drift": 1e-16, "kinetic_energy_start": 0.25, "kinetic_energy_end": 0.125,
                             "elastic_energy_start": null, "energy_drift": -0.5},
                  "stages": [{"name": "neighbours", "seconds": 0.1, "pair_evaluations": 10}], "fields": []}],
        "fronts": [{"group": "taylor_green re=100", "field": "velocity", "norm": "l2", "cost": "seconds",
                    "curves": [{"scheme": "wcsph", "n": [20, 40], "error": [0.1, 0.05], "cost": [1.0, 8.0]}],
                    "rows": [{"scheme": "wcsph", "on_front": true, "slower_by": null, "at_error": 0.05, "than": ""}]}]
    })");
    members["studies"][0]["samples"] = {sample(20, 0.1, ""), sample(40, 0.05, ""),
                                        sample(80, nullptr, "diverged")};
    return with_header(members);
}

// ---- the mapping

TEST_F(Results, EveryKindOfMemberComesBack) {
    const ResultTree tree = with_header(ResultTree::parse(R"({
        "text": "größe ∂u/∂t", "empty": "", "integer": -7, "large": 9223372036854775807, "small": -9223372036854775808,
        "real": 0.1, "whole": 2.0, "tiny": 5e-324, "minus": -0.0, "yes": true, "no": false, "zero": 0, "one": 1,
        "object": {"inner": {"deep": true}, "nothing": {}},
        "integers": [1, 2, 9007199254740993], "reals": [0.5, 1.0], "texts": ["", "a", "∇"], "none": [],
        "items": [{"a": 1}, {"b": [1.5]}, {}],
        "table": [{"n": 1, "e": 0.5, "ok": true, "why": ""}, {"n": 2, "e": 1.0, "ok": false, "why": "∇"}]})"));
    const ResultTree read = round_trip(tree);
    EXPECT_EQ(canonical(read), canonical(tree));
    EXPECT_TRUE(std::signbit(read.at("minus").get<double>()));
}

TEST_F(Results, IsStoredAsTheFormatSays) {
    write_results_hdf5(complete(), path);
    using Names = std::vector<std::string>;
    const Group root = open_hdf5(path);
    EXPECT_EQ(root.attribute<std::string>("format"), "sphvv-results");
    EXPECT_EQ(root.attribute<std::int64_t>("format_version"), 1);
    const Group provenance = root.group("provenance");
    EXPECT_EQ(provenance.attribute<std::uint8_t>("tree_clean"), 0);
    EXPECT_EQ(provenance.attribute_array<std::string>("_booleans"), Names{"tree_clean"});
    EXPECT_EQ(provenance.group("libraries").attribute<std::string>("nlohmann/json"), "3.11.2");
    const Group studies = root.group("studies");
    EXPECT_EQ(studies.attribute<std::string>("_list"), "items");
    EXPECT_EQ(studies.member_names(), Names{"0000"});
    const Group fit = studies.group("0000").group("fit");
    EXPECT_TRUE(std::isnan(fit.dataset<double>("order_l2").at(0)));
    const Group samples = studies.group("0000").group("samples");
    EXPECT_EQ(samples.attribute<std::string>("_list"), "table");
    EXPECT_EQ(samples.attribute_array<std::string>("_booleans"), (Names{"relative", "survived"}));
    EXPECT_EQ(samples.dataset<std::int64_t>("n"), (std::vector<std::int64_t>{20, 40, 80}));
    EXPECT_EQ(samples.dataset<std::uint8_t>("survived"), (std::vector<std::uint8_t>{1, 1, 0}));
    EXPECT_EQ(samples.dataset<std::string>("diagnosis"), (Names{"", "", "diverged"}));
    EXPECT_TRUE(std::isnan(samples.dataset<double>("l2").at(2)));
    EXPECT_TRUE(std::isnan(samples.dataset<double>("l2_spread").at(0)));
    EXPECT_EQ(root.group("runs").group("0000").group("fields").attribute<std::string>("_list"), "empty");
    const Group budget = root.group("runs").group("0000").group("budget");
    EXPECT_EQ(budget.attribute<double>("energy_drift"), -0.5);
    EXPECT_FALSE(budget.has_attribute("elastic_energy_start"));
    // Numbers beside texts fit no column.
    EXPECT_EQ(root.group("cases").group("0000").group("parameters").attribute<std::string>("_list"), "items");
}

TEST_F(Results, NullAndNotANumberAreOne) {
    ResultTree tree = with_header({{"gone", nullptr},
                                   {"undefined", nan_value},
                                   {"array", {nullptr, 1.5, nan_value}},
                                   {"only_null", {nullptr, nullptr}},
                                   {"infinite", std::numeric_limits<double>::infinity()}});
    tree["table"] =
        ResultTree::parse(R"([{"x": 1, "y": null, "t": "a"}, {"x": null, "y": null, "t": null}])");
    const ResultTree read = round_trip(tree);
    EXPECT_FALSE(read.contains("gone") || read.contains("undefined"));
    EXPECT_EQ(read.at("array").dump(), "[null,1.5,null]");
    EXPECT_EQ(read.at("only_null").dump(), "[null,null]");
    EXPECT_TRUE(std::isinf(read.at("infinite").get<double>()));
    EXPECT_EQ(read.at("table").dump(), R"([{"x":1.0,"y":null,"t":"a"},{"x":null,"y":null,"t":""}])");
}

TEST_F(Results, WhatNoColumnCanTellApartBecomesItems) {
    for (const char* rows : {R"([{"v": 1.5}, {"v": "fast"}])", R"([{"v": true}, {"v": 0.5}])",
                             R"([{"v": 9007199254740993}, {"v": 0.5}])", R"([{"v": {}}, {"v": {}}])",
                             R"([{"v": 1}, {"w": 1}])", R"([{"v": 1}, {"v": 1, "w": 1}])", R"([{}, {}])"}) {
        const ResultTree tree = with_header({{"rows", ResultTree::parse(rows)}});
        EXPECT_EQ(canonical(round_trip(tree)), canonical(tree)) << rows;
        EXPECT_EQ(open_hdf5(path).group("rows").attribute<std::string>("_list"), "items") << rows;
    }
    const ResultTree flags =
        with_header({{"rows", ResultTree::parse(R"([{"v": true, "n": 1}, {"v": null, "n": 2}])")}});
    EXPECT_EQ(round_trip(flags).at("rows").dump(), R"([{"v":true,"n":1},{"n":2}])");
}

TEST_F(Results, KeepsTheOrderOfMembersAndOfManyItems) {
    ResultTree tree = with_header({{"zebra", 1}, {"ant", 2}});
    for (int k = 0; k < 12000; ++k) {
        tree["items"].push_back({{"k", k}, {"x", ResultTree::object()}});
    }
    tree["table"] = ResultTree::array({{{"z", 1}, {"a", 2}, {"m", 3}}});
    EXPECT_EQ(round_trip(tree).dump(), tree.dump());
}

TEST_F(Results, RejectsWhatTheFormatHasNoPlaceFor) {
    for (const char* member :
         {R"({"a": [[1]]})", R"({"a": [1, "x"]})", R"({"a": [true, false]})", R"({"a": [1, {}]})",
          R"({"a": [{}, 1]})", R"({"a": 9223372036854775808})", R"({"a": [9223372036854775808]})",
          R"({"a/b": {}})", R"({"a": {"": 1}})", R"({"a": {".": []}})", R"({"a": {"_list": "x"}})",
          R"({"a": {"_booleans": 1}})", R"({"a\u0000b": 1})", R"({"a": [{"b/c": 1}]})"}) {
        const ResultTree tree = with_header(ResultTree::parse(member));
        const std::string message = refusal<std::invalid_argument>([&] { write_results_hdf5(tree, path); });
        expect_mentions(message, {"/a"});
        EXPECT_FALSE(fs::exists(path)) << member;
    }
    EXPECT_THROW(write_results_hdf5(ResultTree::array(), path), std::invalid_argument);
}

/// Random trees, with what must come back of them.
class Grower {
public:
    struct Pair {
        ResultTree given, expected;
    };

    explicit Grower(unsigned seed) : engine_(seed) {}

    Pair object(int depth) {
        Pair pair{ResultTree::object(), ResultTree::object()};
        for (int k = below(7); k > 0; --k) {
            const std::string key = text() + std::to_string(k);
            const Pair value = member(depth);
            pair.given[key] = value.given;
            if (!value.expected.is_null()) {
                pair.expected[key] = value.expected;
            }
        }
        return pair;
    }

private:
    int below(int end) { return std::uniform_int_distribution(0, end - 1)(engine_); }

    std::string text() {
        static const std::vector<std::string> parts{"a",  "Z",  " ",  "é",  "∇",   "𝒲", "_",
                                                    "\"", "\\", "\n", "\t", "<&>", "0"};
        std::string result;
        for (int k = below(5); k > 0; --k) {
            result += parts[below(static_cast<int>(parts.size()))];
        }
        return result;
    }

    double real() {
        const double value = std::bit_cast<double>(engine_());
        return std::isfinite(value) ? value : 0.25;
    }

    std::int64_t integer() {
        return below(2) == 0 ? below(100) - 50 : std::bit_cast<std::int64_t>(engine_());
    }

    ResultTree flat(int kind) {
        switch (kind) {
        case 0:
            return text();
        case 1:
            return integer();
        case 2:
            return real();
        default:
            return below(2) == 0;
        }
    }

    Pair array(int kind) {
        Pair pair{ResultTree::array(), ResultTree::array()};
        for (int k = below(5); k > 0; --k) {
            const ResultTree value = kind == 2 && below(3) == 0 ? ResultTree() : flat(kind);
            pair.given.push_back(value);
            pair.expected.push_back(value);
        }
        return pair;
    }

    Pair table() {
        std::vector<int> kinds{2}; // a real, so that rows are not mistaken for another table's
        for (int k = below(5); k > 0; --k) {
            kinds.push_back(below(4));
        }
        Pair pair{ResultTree::array(), ResultTree::array()};
        for (int row = below(4); row > 0; --row) {
            ResultTree given = ResultTree::object();
            ResultTree expected = ResultTree::object();
            for (std::size_t c = 0; c < kinds.size(); ++c) {
                const std::string key = "c" + std::to_string(c);
                const bool null = (kinds[c] == 0 || kinds[c] == 2) && below(4) == 0;
                given[key] = null ? ResultTree() : flat(kinds[c]);
                expected[key] = null && kinds[c] == 0 ? ResultTree("") : given[key];
            }
            // The first row has no null: a column of nothing else would come back as one of numbers.
            for (std::size_t c = 0; row == 1 && c < kinds.size(); ++c) {
                const std::string key = "c" + std::to_string(c);
                given[key] = expected[key] = flat(kinds[c]);
            }
            pair.given.push_back(given);
            pair.expected.push_back(expected);
        }
        return pair;
    }

    Pair items(int depth) {
        Pair pair{ResultTree::array(), ResultTree::array()};
        for (int k = below(4); k > 0; --k) {
            Pair item = object(depth - 1);
            item.given["not flat"] = item.expected["not flat"] = ResultTree::object();
            pair.given.push_back(item.given);
            pair.expected.push_back(item.expected);
        }
        return pair;
    }

    Pair member(int depth) {
        const int kind = below(depth > 0 ? 12 : 5);
        if (kind == 4) {
            return {};
        }
        if (kind < 4) {
            const ResultTree value = flat(kind);
            return {value, value};
        }
        if (kind < 8) {
            return array(kind - 5);
        }
        return kind < 10 ? table() : kind == 10 ? items(depth) : object(depth - 1);
    }

    std::mt19937_64 engine_;
};

TEST_F(Results, RandomTreesComeBack) {
    std::size_t characters = 0;
    for (unsigned seed = 1; seed <= 400; ++seed) {
        const Grower::Pair pair = Grower(seed).object(5);
        const std::string expected = canonical(with_header(pair.expected));
        ASSERT_EQ(canonical(round_trip(with_header(pair.given))), expected) << "seed " << seed;
        ASSERT_EQ(canonical(round_trip(read_results_hdf5(path))), expected) << "seed " << seed;
        characters += expected.size();
    }
    EXPECT_GT(characters, 100000U);
}

// ---- files that are not what they should be

TEST_F(Results, SaysWhyAFileIsNoResultFile) {
    const auto reading = [](const fs::path& file) {
        return refusal<UserError>([&] { read_results_hdf5(file); });
    };
    expect_mentions(reading(path), {path.string(), "does not exist"});
    expect_mentions(reading(folder), {"folder"});
    put(path, "");
    expect_mentions(reading(path), {"empty"});
    put(path, "{\"format\": \"sphvv-results\"}");
    expect_mentions(reading(path), {"not an HDF5 file"});
    write_hdf5(path, [](const Group& root) { root.set_attribute<double>("energy", 1); });
    expect_mentions(reading(path), {path.string(), "not a result file of sphvv"});
    write_hdf5(path, [](const Group& root) { root.set_attribute<std::string>("format", "sphvv-snapshot"); });
    expect_mentions(reading(path), {"not a result file of sphvv"});
    const auto with_version = [&](std::int64_t version) {
        write_hdf5(path, [&](const Group& root) {
            root.set_attribute<std::string>("format", "sphvv-results");
            root.set_attribute("format_version", version);
        });
        return path;
    };
    expect_mentions(reading(with_version(2)), {"newer sphvv", "2"});
    expect_mentions(reading(with_version(0)), {"format_version"});
    EXPECT_EQ(read_results_hdf5(with_version(1)).size(), 2U);
}

TEST_F(Results, SaysWhatInAFileContradictsTheFormat) {
    const auto reading = [&](auto&& fill) {
        write_hdf5(path, [&](const Group& root) {
            root.set_attribute<std::string>("format", "sphvv-results");
            root.set_attribute<std::int64_t>("format_version", 1);
            fill(root.create_group("g"));
        });
        return refusal<UserError>([&] { read_results_hdf5(path); });
    };
    const std::vector<double> numbers{1, 2, 3, 4};
    const std::span<const double> all(numbers);
    expect_mentions(reading([](const Group& g) { g.set_attribute<std::string>("_list", "heap"); }),
                    {"/g", "heap"});
    expect_mentions(reading([&](const Group& g) { g.create_dataset("m", all, 2); }), {"/g/m", "dimension"});
    expect_mentions(reading([&](const Group& g) { g.set_attribute_array("v", all); }),
                    {"/g/v", "single value"});
    expect_mentions(reading([&](const Group& g) {
                        g.set_attribute<std::string>("_list", "table");
                        g.create_dataset("a", all);
                        g.create_dataset("b", all.first(3));
                    }),
                    {"/g", "differ in length"});
    expect_mentions(reading([](Group g) {
                        for (int k = 0; k < 200; ++k) {
                            g = g.create_group("g");
                        }
                    }),
                    {"nests deeper"});
}

TEST_F(Results, AFullDiskLeavesNothing) {
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2000, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = refusal<UserError>([&] { write_results_hdf5(complete(), path); });
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    expect_mentions(message, {path.string(), "cannot be written"});
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(Results, NoTruncatedFileIsRead) {
    write_results_hdf5(complete(), path);
    const std::string whole = content(path);
    for (std::size_t length = 0; length < whole.size(); length += length < 200 ? 1 : 131) {
        put(path, whole.substr(0, length));
        expect_mentions(refusal<UserError>([&] { read_results_hdf5(path); }), {path.string()});
    }
}

/// Reads a damaged file to its end; whatever comes out, it is an error in words or a tree that can be
/// written.
void expect_refusal_or_tree(const fs::path& file, int& refused) {
    try {
        const ResultTree tree = read_results_hdf5(file);
        EXPECT_FALSE(tree.dump().empty());
        check_result_file(tree, file);
    } catch (const UserError& error) {
        EXPECT_EQ(std::string(error.what()).find(file.string()), 0U) << error.what();
        ++refused;
    }
}

TEST_F(Results, DamagedFilesAreRefusedOrRead) {
    write_results_hdf5(complete(), path);
    const std::string whole = content(path);
    constexpr int trials = SPHVV_DAMAGE_TRIALS;
    int refused = 0;
    for (int trial = 0; trial < trials; ++trial) {
        std::mt19937_64 engine(static_cast<unsigned>(trial));
        const auto below = [&](std::size_t end) { return engine() % end; };
        std::string damaged = whole;
        for (std::size_t flips = trial % 2 == 0 ? 1 : 1 + below(16); flips > 0; --flips) {
            damaged[below(damaged.size())] ^= static_cast<char>(1 << below(8));
        }
        put(path, damaged);
        expect_refusal_or_tree(path, refused);
    }
    EXPECT_GT(refused, trials / 2);
}

TEST_F(Results, DamagedTextsAreRefusedOrRead) {
    // The heaps of texts are the part of a file that has no checksum.
    write_results_hdf5(complete(), path);
    const std::string whole = content(path);
    std::vector<std::size_t> heaps;
    for (std::size_t at = whole.find("GCOL"); at != std::string::npos; at = whole.find("GCOL", at + 1)) {
        heaps.push_back(at);
    }
    ASSERT_FALSE(heaps.empty());
    int refused = 0;
    for (int trial = 0; trial < SPHVV_DAMAGE_TRIALS; ++trial) {
        std::mt19937_64 engine(static_cast<unsigned>(trial));
        std::string damaged = whole;
        damaged[heaps[engine() % heaps.size()] + engine() % 4096] = static_cast<char>(engine());
        put(path, damaged);
        expect_refusal_or_tree(path, refused);
    }
    EXPECT_GT(refused, 0);
}

// ---- completeness

TEST_F(Results, ACompleteFilePasses) {
    EXPECT_NO_THROW(check_result_file(complete(), path));
    EXPECT_NO_THROW(check_result_file(round_trip(complete()), path));
}

std::string fault_after(const std::string& pointer, const ResultTree& value, const fs::path& path) {
    ResultTree tree = complete();
    tree[ResultTree::json_pointer(pointer)] = value;
    return refusal<UserError>([&] { check_result_file(tree, path); });
}

std::string fault_without(const std::string& pointer, const std::string& name, const fs::path& path) {
    ResultTree tree = complete();
    EXPECT_EQ(tree.at(ResultTree::json_pointer(pointer)).erase(name), 1U) << name;
    return refusal<UserError>([&] { check_result_file(tree, path); });
}

TEST_F(Results, AMissingMemberIsNamed) {
    const std::vector<std::array<std::string, 3>> required{
        {"", "command", "command"},
        {"", "provenance", "provenance"},
        {"", "studies", "studies"},
        {"/provenance", "revision", "provenance.revision"},
        {"/cases/0", "name", "cases[0].name"},
        {"/studies/0", "fit", "studies[0].fit"},
        {"/studies/0/fit", "verdict", "studies[0].fit.verdict"},
        {"/studies/0/samples/1", "l2", "studies[0].samples[1].l2"},
        {"/runs/0", "survived", "runs[0].survived"},
        {"/fronts/0/rows/0", "than", "fronts[0].rows[0].than"}};
    for (const auto& [pointer, name, where] : required) {
        expect_mentions(fault_without(pointer, name, path), {path.string(), where + " is missing"});
    }
    expect_mentions(fault_without("", "format", path), {"not a result file"});
    expect_mentions(fault_without("", "format_version", path), {"format_version"});
    expect_mentions(refusal<UserError>([&] { check_result_file(ResultTree::array(), path); }),
                    {"not a result file"});
}

TEST_F(Results, AWrongMemberIsNamed) {
    expect_mentions(fault_after("/format_version", 2, path), {"newer"});
    expect_mentions(fault_after("/format_version", "1", path), {"format_version"});
    expect_mentions(fault_after("/provenance", 1, path), {"provenance is not an object"});
    expect_mentions(fault_after("/studies", ResultTree::object(), path), {"studies is not a list"});
    expect_mentions(fault_after("/studies/0", 3, path), {"studies[0] is not an object"});
    expect_mentions(fault_after("/studies/0/expected/low", "1", path),
                    {"studies[0].expected.low is not a number"});
    expect_mentions(fault_after("/studies/0/samples/0/survived", 1, path),
                    {"samples[0].survived is not a boolean"});
    expect_mentions(fault_after("/runs/0/budget", 1, path), {"runs[0].budget is not an object"});
    expect_mentions(fault_after("/runs/0/budget/energy_drift", "0", path),
                    {"runs[0].budget.energy_drift is not a number"});
    expect_mentions(fault_after("/studies/0/fit/verdict", "GOOD", path), {"studies[0].fit.verdict", "GOOD"});
    expect_mentions(fault_after("/studies/0/fit/verdict", nullptr, path), {"studies[0].fit.verdict"});
    expect_mentions(fault_after("/studies/0/fit/order_l2", {1.0, 2.0}, path),
                    {"order_l2", "2 entries for 3 rungs"});
    expect_mentions(fault_after("/studies/0/fit/order_l2", {1.0, "x", 2.0}, path), {"an array of numbers"});
    expect_mentions(fault_after("/fronts/0/curves/0/cost", {1.0}, path),
                    {"fronts[0].curves[0]", "differ in length"});
}

TEST_F(Results, WhatMayBeMissingMay) {
    for (const auto& [pointer, name] :
         std::vector<std::array<std::string, 2>>{{"/provenance", "threads"},
                                                 {"/cases/0", "parameters"},
                                                 {"/runs/0", "budget"},
                                                 {"/runs/0/budget", "momentum_drift"},
                                                 {"/studies/0", "expected"},
                                                 {"/studies/0/fit", "order_l2"}}) {
        ResultTree tree = complete();
        tree[ResultTree::json_pointer(pointer)].erase(name);
        EXPECT_NO_THROW(check_result_file(tree, path)) << name;
        tree[ResultTree::json_pointer(pointer)][name] = nullptr;
        EXPECT_NO_THROW(check_result_file(tree, path)) << name;
    }
}

} // namespace
