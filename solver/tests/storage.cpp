#include "sphvv/solver/error.hpp"
#include "sphvv/solver/storage/hdf5.hpp"
#include "sphvv/solver/storage/text.hpp"
#include "sphvv/solver/storage/trial_reading.hpp"
#include "sphvv/solver/storage/write_atomically.hpp"
#include "sphvv/solver/tests/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace {

using namespace sphvv::solver::storage;
using sphvv::UserError;
using sphvv::tests::content;
using sphvv::tests::expect_mentions;
using sphvv::tests::put;
using sphvv::tests::refusal;
namespace fs = std::filesystem;

using Storage = sphvv::tests::TemporaryFolder;

std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// Lets no file of this process grow beyond some bytes: what a full disk does, without one.
class SmallDisk {
public:
    explicit SmallDisk(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    ~SmallDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*handler_)(int);
};

/// The privileges of nobody in particular; root may read and write everything.
class Unprivileged {
public:
    Unprivileged() : user_(::geteuid()) {
        if (user_ == 0) {
            EXPECT_EQ(::seteuid(65534), 0);
        }
    }
    Unprivileged(const Unprivileged&) = delete;
    Unprivileged& operator=(const Unprivileged&) = delete;
    ~Unprivileged() { EXPECT_EQ(::seteuid(user_), 0); }

private:
    uid_t user_;
};

// ---- text

TEST(Text, KeepsUtf8AndReplacesTheRest) {
    const std::string sound = "plain, ∂u/∂t + (u·∇)u = −∇p/ρ, é, 𝒲, \u07FF\u0800\uD7FF\uE000\U0010FFFF";
    EXPECT_EQ(valid_utf8(sound), sound);
    const std::string mark = "\uFFFD";
    EXPECT_EQ(valid_utf8("a\xFFz"), "a" + mark + "z");
    EXPECT_EQ(valid_utf8(std::string_view("a\0z", 3)), "a" + mark + "z");
    EXPECT_EQ(valid_utf8("cut \xE2\x88"), "cut " + mark + mark);
    EXPECT_EQ(valid_utf8("\xC0\x80"), mark + mark) << "overlong";
    EXPECT_EQ(valid_utf8("\xE0\x9F\xBF"), mark + mark + mark) << "overlong";
    EXPECT_EQ(valid_utf8("\xF0\x8F\xBF\xBF"), mark + mark + mark + mark) << "overlong";
    EXPECT_EQ(valid_utf8("\xED\xA0\x80"), mark + mark + mark) << "surrogate";
    EXPECT_EQ(valid_utf8("\xF4\x90\x80\x80"), mark + mark + mark + mark) << "above U+10FFFF";
    EXPECT_EQ(valid_utf8("\xE2z\x88"), mark + "z" + mark);
    EXPECT_EQ(valid_utf8("\xE2\x88z"), mark + mark + "z");
}

// ---- write_atomically

TEST_F(Storage, WritesAndReplacesAFile) {
    const fs::path path = folder / "file";
    write_atomically(path, "one");
    EXPECT_EQ(content(path), "one");
    write_atomically(path, std::string_view("t\0w", 3));
    EXPECT_EQ(content(path), std::string("t\0w", 3));
    write_atomically(path, "");
    EXPECT_EQ(content(path), "");
    EXPECT_EQ(entries(folder), 1U);
}

TEST_F(Storage, WritesIntoTheCurrentFolder) {
    const fs::path before = fs::current_path();
    fs::current_path(folder);
    write_atomically("plain", "x");
    fs::current_path(before);
    EXPECT_EQ(content(folder / "plain"), "x");
}

TEST_F(Storage, NewFilesHaveThePermissionsOfTheUsersMaskAndOldOnesKeepTheirs) {
    const mode_t mask = ::umask(027);
    write_atomically(folder / "new", "x");
    put(folder / "old", "x");
    fs::permissions(folder / "old", fs::perms(0604));
    write_atomically(folder / "old", "y");
    ::umask(mask);
    EXPECT_EQ(fs::status(folder / "new").permissions(), fs::perms(0640));
    EXPECT_EQ(fs::status(folder / "old").permissions(), fs::perms(0604));
}

TEST_F(Storage, FollowsASymbolicLink) {
    fs::create_directory(folder / "there");
    put(folder / "there" / "target", "old");
    fs::create_symlink(folder / "there" / "target", folder / "link");
    write_atomically(folder / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(content(folder / "there" / "target"), "new");
    EXPECT_EQ(entries(folder / "there"), 1U);
}

TEST_F(Storage, AFullDiskLeavesTheOldFileAndNothingElse) {
    const fs::path path = folder / "file";
    const std::string big(100000, 'x');
    {
        const SmallDisk disk(4096);
        expect_mentions(refusal([&] { write_atomically(path, big); }),
                        {path.string(), "cannot be written", "too large"});
    }
    EXPECT_EQ(entries(folder), 0U);
    write_atomically(path, "old");
    {
        const SmallDisk disk(4096);
        refusal([&] { write_atomically(path, big); });
    }
    EXPECT_EQ(content(path), "old");
    EXPECT_EQ(entries(folder), 1U);
}

TEST_F(Storage, RefusesPlacesWhereNoFileCanBe) {
    expect_mentions(refusal([&] { write_atomically(folder, "x"); }), {folder.string(), "folder"});
    expect_mentions(refusal([&] { write_atomically(folder / "no" / "file", "x"); }),
                    {"no folder", (folder / "no").string()});
    expect_mentions(refusal([&] { write_atomically("", "x"); }), {"no file is named"});
    expect_mentions(refusal([&] { write_atomically(folder / "new" / "", "x"); }), {"cannot be written"});
    put(folder / "file", "old");
    expect_mentions(refusal([&] { write_atomically(folder / "file" / "in", "x"); }), {"no folder"});
    expect_mentions(refusal([&] { write_atomically(folder / std::string(300, 'n'), "x"); }), {"too long"});
    EXPECT_EQ(entries(folder), 1U);
}

TEST_F(Storage, DoesNotReplaceWhatIsNoRegularFile) {
    // A pipe stands for every device: a fault here must not cost the machine its /dev/null.
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    expect_mentions(refusal([&] { write_atomically(pipe, "x"); }), {pipe.string(), "not a regular file"});
    fs::create_symlink(pipe, folder / "link");
    expect_mentions(refusal([&] { write_atomically(folder / "link", "x"); }), {"link", "not a regular file"});
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(entries(folder), 2U);
}

TEST_F(Storage, RespectsPermissions) {
    put(folder / "file", "old");
    fs::permissions(folder / "file", fs::perms(0444));
    fs::create_directory(folder / "closed");
    fs::permissions(folder / "closed", fs::perms(0555));
    fs::permissions(folder, fs::perms(0777));
    {
        const Unprivileged user;
        expect_mentions(refusal([&] { write_atomically(folder / "file", "new"); }), {"Permission denied"});
        expect_mentions(refusal([&] { write_atomically(folder / "closed" / "new", "x"); }),
                        {"Permission denied"});
    }
    EXPECT_EQ(content(folder / "file"), "old");
    fs::permissions(folder / "closed", fs::perms(0755));
    EXPECT_EQ(entries(folder / "closed"), 0U);
}

TEST_F(Storage, LeavesTheTemporaryFileOfAnotherWriterAlone) {
    const fs::path other = folder / (".sphvv-part-" + std::to_string(::getpid()) + "-0");
    put(other, "another");
    write_atomically(folder / "file", "own");
    EXPECT_EQ(content(other), "another");
    EXPECT_EQ(content(folder / "file"), "own");
}

TEST_F(Storage, ManyWritersDoNotMeet) {
    const fs::path path = folder / "file";
#pragma omp parallel for
    for (int k = 0; k < 64; ++k) {
        write_atomically(path, std::string(10000, static_cast<char>('a' + k % 26)));
    }
    const std::string last = content(path);
    EXPECT_EQ(last, std::string(10000, last.at(0)));
    EXPECT_EQ(entries(folder), 1U);
}

// ---- HDF5

const std::vector<double> reals{
    0.0, -0.0, 0.1, -1e-308, 5e-324, 1e308, std::numeric_limits<double>::infinity()};
const std::vector<std::int64_t> integers{0, -1, INT64_MAX, INT64_MIN, (1LL << 53) + 1};
const std::vector<std::uint8_t> flags{0, 1, 255};
const std::vector<std::string> texts{"", "plain", "∂u/∂t = −∇p/ρ", std::string(70000, 'x')};

template <class T>
std::span<const T> all(const std::vector<T>& values) {
    return values;
}

void write_example(const fs::path& path) {
    write_hdf5(path, [](const Group& root) {
        root.set_attribute<std::string>("text", "größe");
        root.set_attribute<std::string>("empty", "");
        root.set_attribute("real", 0.1);
        root.set_attribute<std::int64_t>("integer", INT64_MIN);
        root.set_attribute<std::uint8_t>("flag", 1);
        root.set_attribute_array("names", all(texts));
        root.create_dataset("reals", all(reals));
        root.create_dataset("none", std::span<const double>());
        const Group group = root.create_group("group");
        group.create_dataset("integers", all(integers));
        group.create_dataset("flags", all(flags));
        group.create_dataset("texts", all(texts));
        group.create_dataset("matrix", all(std::vector<double>{1, 2, 3, 4, 5, 6}), 3);
        group.create_group("inner").set_attribute<std::int64_t>("deep", 7);
    });
}

TEST_F(Storage, ReadsBackWhatWasWritten) {
    write_example(folder / "e.h5");
    write_example(folder / "e.h5"); // in place of the first
    const Group root = open_hdf5(folder / "e.h5");
    EXPECT_EQ(root.attribute<std::string>("text"), "größe");
    EXPECT_EQ(root.attribute<std::string>("empty"), "");
    EXPECT_EQ(root.attribute<double>("real"), 0.1);
    EXPECT_EQ(root.attribute<double>("integer"), static_cast<double>(INT64_MIN));
    EXPECT_EQ(root.attribute<std::int64_t>("integer"), INT64_MIN);
    EXPECT_EQ(root.attribute<std::uint8_t>("flag"), 1);
    EXPECT_EQ(root.attribute_array<std::string>("names"), texts);
    const std::vector<double> read = root.dataset<double>("reals");
    ASSERT_EQ(read.size(), reals.size());
    EXPECT_EQ(std::memcmp(read.data(), reals.data(), sizeof(double) * reals.size()), 0);
    EXPECT_TRUE(root.dataset<double>("none").empty());
    const Group group = root.group("group");
    EXPECT_EQ(group.dataset<std::int64_t>("integers"), integers);
    EXPECT_EQ(group.dataset<std::uint8_t>("flags"), flags);
    EXPECT_EQ(group.dataset<std::string>("texts"), texts);
    EXPECT_EQ(group.dataset<double>("matrix"), (std::vector<double>{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(group.group("inner").attribute<std::int64_t>("deep"), 7);
    EXPECT_EQ(group.group("inner").place(), "/group/inner");
}

TEST_F(Storage, TellsWhatThereIsInTheOrderItWasMade) {
    write_example(folder / "e.h5");
    const Group root = open_hdf5(folder / "e.h5");
    using Names = std::vector<std::string>;
    EXPECT_EQ(root.attribute_names(), (Names{"text", "empty", "real", "integer", "flag", "names"}));
    EXPECT_EQ(root.member_names(), (Names{"reals", "none", "group"}));
    EXPECT_EQ(root.attribute_kind("text"), Kind::text);
    EXPECT_EQ(root.attribute_kind("real"), Kind::real);
    EXPECT_EQ(root.attribute_kind("flag"), Kind::integer);
    EXPECT_TRUE(root.has_attribute("real") && !root.has_attribute("reals") && !root.has_member("real"));
    EXPECT_TRUE(root.has_member("reals") && root.is_group("group") && !root.is_group("reals"));
    const Extent matrix = root.group("group").extent("matrix");
    EXPECT_TRUE(matrix.kind == Kind::real && matrix.rows == 2 && matrix.columns == 3);
    const Extent none = root.extent("none");
    EXPECT_TRUE(none.kind == Kind::real && none.rows == 0 && none.columns == 1);
}

TEST_F(Storage, HoldsManyMembersAndLongDatasets) {
    const int count = 3000;             // more than a group keeps in its header
    std::vector<double> longer(200001); // several chunks
    for (std::size_t k = 0; k < longer.size(); ++k) {
        longer[k] = static_cast<double>(k);
    }
    write_hdf5(folder / "e.h5", [&](const Group& root) {
        for (int k = count; k > 0; --k) {
            root.create_group("g" + std::to_string(k)).set_attribute<std::int64_t>("k", k);
            root.set_attribute<std::int64_t>("a" + std::to_string(k), k);
        }
        root.create_dataset("long", all(longer), 3);
    });
    const Group root = open_hdf5(folder / "e.h5");
    ASSERT_EQ(root.member_names().size(), count + 1U);
    EXPECT_EQ(root.member_names().front(), "g3000");
    EXPECT_EQ(root.attribute_names().front(), "a3000");
    EXPECT_EQ(root.attribute<std::int64_t>("a1"), 1);
    EXPECT_EQ(root.group("g17").attribute<std::int64_t>("k"), 17);
    EXPECT_EQ(root.dataset<double>("long"), longer);
}

TEST_F(Storage, TheSameContentGivesTheSameBytes) {
    write_example(folder / "a.h5");
    ::sleep(1); // HDF5 keeps times in seconds
    write_example(folder / "b.h5");
    EXPECT_EQ(content(folder / "a.h5"), content(folder / "b.h5"));
}

TEST_F(Storage, AFailedCompositionLeavesTheOldFile) {
    write_example(folder / "e.h5");
    const std::string before = content(folder / "e.h5");
    EXPECT_THROW(write_hdf5(folder / "e.h5", [](const Group& root) { root.create_group("g"), throw 1; }),
                 int);
    {
        const SmallDisk disk(1000);
        expect_mentions(refusal([&] { write_example(folder / "e.h5"); }),
                        {"e.h5", "cannot be written", "too large"});
    }
    EXPECT_EQ(content(folder / "e.h5"), before);
    EXPECT_EQ(entries(folder), 1U);
    expect_mentions(refusal([&] {
                        write_hdf5(folder / "n.h5", [](const Group& root) {
                            root.create_group("twice");
                            root.create_group("twice");
                        });
                    }),
                    {"n.h5", "cannot be written", "/twice"});
    EXPECT_EQ(entries(folder), 1U);
}

TEST_F(Storage, NamesWhatIsMissingOrOfAnotherKind) {
    write_example(folder / "e.h5");
    const Group root = open_hdf5(folder / "e.h5");
    const std::string file = (folder / "e.h5").string();
    expect_mentions(refusal([&] { root.attribute<double>("time"); }), {file, "no attribute /time"});
    expect_mentions(refusal([&] { root.group("group").dataset<double>("p"); }), {file, "no member /group/p"});
    expect_mentions(refusal([&] { root.group("reals"); }), {"/reals is not a group"});
    expect_mentions(refusal([&] { root.dataset<double>("group"); }), {"/group is not a dataset"});
    expect_mentions(refusal([&] { root.attribute<double>("text"); }), {"/text is not a number"});
    expect_mentions(refusal([&] { root.attribute<std::int64_t>("real"); }), {"/real is not an integer"});
    expect_mentions(refusal([&] { root.attribute<std::string>("real"); }), {"/real is not a text"});
    expect_mentions(refusal([&] { root.attribute<std::string>("names"); }), {"/names is not a single value"});
    expect_mentions(refusal([&] { root.group("group").dataset<std::int64_t>("texts"); }), {"/group/texts"});
}

TEST_F(Storage, SaysWhyAFileCannotBeRead) {
    const auto opening = [](const fs::path& path) { return refusal([&] { open_hdf5(path); }); };
    expect_mentions(opening(folder / "none.h5"), {"none.h5", "does not exist"});
    expect_mentions(opening(folder), {folder.string(), "folder"});
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    expect_mentions(opening(folder / "pipe"), {"not a regular file"});
    put(folder / "empty.h5", "");
    expect_mentions(opening(folder / "empty.h5"), {"empty"});
    put(folder / "text.h5", "format = sphvv-results\n");
    expect_mentions(opening(folder / "text.h5"), {"not an HDF5 file"});
    put(folder / "head.h5", "\x89HDF\r\n\x1a\n");
    expect_mentions(opening(folder / "head.h5"), {"truncated or damaged"});
    write_example(folder / "e.h5");
    fs::permissions(folder, fs::perms(0755));
    fs::permissions(folder / "e.h5", fs::perms(0000));
    const Unprivileged user;
    expect_mentions(opening(folder / "e.h5"), {"cannot be read", "Permission denied"});
}

TEST_F(Storage, TheLibraryKeepsQuiet) {
    put(folder / "head.h5", "\x89HDF\r\n\x1a\n");
    testing::internal::CaptureStderr();
    refusal([&] { open_hdf5(folder / "head.h5"); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Storage, ComposingDoesNotReadWhatIsThere) {
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0); // it would wait for ever
    expect_mentions(refusal([&] { write_example(folder / "pipe"); }), {"not a regular file"});
}

/// A file made with the library alone.
template <class Fill>
void make_foreign(const fs::path& path, Fill&& fill) {
    const Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    ASSERT_TRUE(file.valid());
    fill(file.get());
}

TEST_F(Storage, WaysOutOfTheTreeAreRefused) {
    write_example(folder / "e.h5");
    make_foreign(folder / "links.h5", [](hid_t file) {
        const Handle group(H5Gcreate2(file, "group", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        EXPECT_GE(H5Lcreate_soft("/group", file, "soft", H5P_DEFAULT, H5P_DEFAULT), 0);
        EXPECT_GE(H5Lcreate_external("e.h5", "/group", file, "external", H5P_DEFAULT, H5P_DEFAULT), 0);
        const Handle twice(H5Gcreate2(file, "twice", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        EXPECT_GE(H5Lcreate_hard(file, "twice", twice.get(), "itself", H5P_DEFAULT, H5P_DEFAULT), 0);
    });
    const Group root = open_hdf5(folder / "links.h5");
    EXPECT_EQ(root.member_names().size(), 4U);
    EXPECT_TRUE(root.is_group("group"));
    expect_mentions(refusal([&] { root.group("soft"); }), {"/soft is a link"});
    expect_mentions(refusal([&] { root.is_group("external"); }), {"/external is a link"});
    expect_mentions(refusal([&] { root.group("twice"); }), {"/twice has a second place"});
}

TEST_F(Storage, MoreThanAFileCanHoldIsRefused) {
    make_foreign(folder / "huge.h5", [](hid_t file) {
        const hsize_t count = 1000000000000;
        const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
        const Handle set(
            H5Dcreate2(file, "x", H5T_NATIVE_DOUBLE, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
            H5Dclose);
        EXPECT_TRUE(set.valid());
    });
    const Group root = open_hdf5(folder / "huge.h5");
    EXPECT_EQ(root.extent("x").rows, 1000000000000U);
    expect_mentions(refusal([&] { root.dataset<double>("x"); }), {"damaged", "/x"});
}

TEST_F(Storage, ReadsTextsOfFixedLengthAndRefusesOtherKinds) {
    make_foreign(folder / "fixed.h5", [](hid_t file) {
        const hsize_t count = 2;
        const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
        for (const auto& [name, padding] :
             {std::pair("null", H5T_STR_NULLPAD), std::pair("space", H5T_STR_SPACEPAD)}) {
            const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
            H5Tset_size(type.get(), 4);
            H5Tset_strpad(type.get(), padding);
            const Handle attribute(H5Acreate2(file, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                                   H5Aclose);
            EXPECT_GE(
                H5Awrite(attribute.get(), type.get(), padding == H5T_STR_NULLPAD ? "ab\0\0wxyz" : "a b wxyz"),
                0);
        }
        const Handle type(H5Tcreate(H5T_OPAQUE, 4), H5Tclose);
        const Handle attribute(H5Acreate2(file, "opaque", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    });
    const Group root = open_hdf5(folder / "fixed.h5");
    using Texts = std::vector<std::string>;
    EXPECT_EQ(root.attribute_array<std::string>("null"), (Texts{"ab", "wxyz"}));
    EXPECT_EQ(root.attribute_array<std::string>("space"), (Texts{"a b", "wxyz"}));
    EXPECT_EQ(root.attribute_kind("opaque"), Kind::other);
    expect_mentions(refusal([&] { root.attribute_array<double>("opaque"); }), {"/opaque is not a number"});
}

TEST_F(Storage, NoFlippedBitChangesANumberOrMixesUpTexts) {
    const std::vector<std::string> words{"north", "south"};
    write_hdf5(folder / "e.h5", [&](const Group& root) {
        root.set_attribute<std::int64_t>("integer", 7);
        root.create_dataset("reals", all(reals));
        root.create_dataset("long", all(std::vector<double>(9000, 0.1))); // too long for the header
        root.create_dataset("words", all(words));
    });
    const std::string whole = content(folder / "e.h5");
    const std::size_t heap = whole.find("GCOL");
    ASSERT_NE(heap, std::string::npos);
    int refused = 0;
    for (std::size_t byte = 0; byte < whole.size(); byte += byte < 3000 ? 7 : 211) {
        if (byte >= heap && byte < heap + 4096) {
            continue; // the texts themselves
        }
        std::string damaged = whole;
        damaged[byte] = static_cast<char>(damaged[byte] ^ 1 << byte % 8);
        put(folder / "d.h5", damaged);
        try {
            const Group root = open_hdf5(folder / "d.h5");
            EXPECT_EQ(root.attribute<std::int64_t>("integer"), 7) << byte;
            EXPECT_EQ(root.dataset<double>("reals"), reals) << byte;
            EXPECT_EQ(root.dataset<double>("long"), std::vector<double>(9000, 0.1)) << byte;
            EXPECT_EQ(root.dataset<std::string>("words"), words) << byte;
        } catch (const UserError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 100);
}

/// 9 MB of groups and attributes are what the operators of a nightly tier leave; reading all takes seconds.
TEST_F(Storage, ATrialIsLongEnoughForAnyHealthyFile) {
    write_hdf5(folder / "many.h5", [](const Group& root) {
        for (int k = 0; k < 9000; ++k) {
            const Group group = root.create_group("g" + std::to_string(k));
            for (int j = 0; j < 24; ++j) {
                group.set_attribute<std::string>("a" + std::to_string(j), "text");
            }
        }
    });
    EXPECT_GT(fs::file_size(folder / "many.h5"), 9'000'000U);
    EXPECT_NO_THROW(read_in_trial(folder / "many.h5"));
}

TEST_F(Storage, EveryTruncatedFileIsRefused) {
    write_example(folder / "e.h5");
    const std::string whole = content(folder / "e.h5");
    for (std::size_t length = 1; length < whole.size(); length += length < 300 ? 1 : 997) {
        put(folder / "cut.h5", whole.substr(0, length));
        const std::string message = refusal([&] { open_hdf5(folder / "cut.h5"); });
        expect_mentions(message, {length < 8 ? "not an HDF5 file" : "truncated or damaged"});
    }
    put(folder / "cut.h5", whole.substr(0, whole.size() - 1));
    expect_mentions(refusal([&] { open_hdf5(folder / "cut.h5"); }), {"truncated or damaged"});
}

TEST_F(Storage, ADamagedHeapOfTextsIsRefused) {
    write_example(folder / "e.h5");
    const std::string whole = content(folder / "e.h5");
    int heaps = 0;
    for (std::size_t heap = whole.find("GCOL"); heap != std::string::npos;
         heap = whole.find("GCOL", heap + 1)) {
        ++heaps;
        for (const std::size_t byte : {24U, 25U, 28U, 31U}) { // the size of the first object
            std::string damaged = whole;
            damaged[heap + byte] = static_cast<char>(damaged[heap + byte] ^ 0x40);
            put(folder / "d.h5", damaged);
            const std::string message = refusal([&] {
                const Group root = open_hdf5(folder / "d.h5");
                root.attribute<std::string>("text");
            });
            expect_mentions(message, {"damaged", "/text"});
        }
    }
    EXPECT_GE(heaps, 2);
}

} // namespace
