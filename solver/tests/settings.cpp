// What a user may write for a key, what is refused, and what the refusal says.
#include "sphvv/solver/settings.hpp"

#include "sphvv/solver/tests/scenes.hpp"

#include <gtest/gtest.h>

#include <bit>

namespace sphvv::solver {
namespace {

const std::vector<Key> keys{Key::number("viscosity", 0.25, 0, 1.5, "m2/s", "a number"),
                            Key::integer("layers", 3, -2, 8, "an integer"),
                            Key::word("gradient", "plain", {"plain", "normalised"}, "a word")};

/// The message that the assignments are refused with, or "" if they are accepted.
std::string refusal(const Assignments& given) {
    try {
        const Settings settings(keys, given);
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

void expect_names(const std::string& message, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        EXPECT_NE(message.find(word), std::string::npos) << '"' << word << "\" is not in: " << message;
    }
}

TEST(Settings, HasTheDeclaredValues) {
    const Settings settings(keys, {});
    EXPECT_EQ(settings.number("viscosity"), 0.25);
    EXPECT_EQ(settings.text("viscosity"), "0.25");
    EXPECT_EQ(settings.integer("layers"), 3);
    EXPECT_EQ(settings.word("gradient"), "plain");
    EXPECT_TRUE(settings.has("layers"));
    EXPECT_FALSE(settings.has("layer"));
    EXPECT_EQ(settings.keys().size(), 3);
}

TEST(Settings, TakesWhatIsGiven) {
    const Settings settings(keys, {{"viscosity", "1.50e-1"}, {"layers", "-2"}, {"gradient", "normalised"}});
    EXPECT_EQ(settings.number("viscosity"), 0.15);
    EXPECT_EQ(settings.text("viscosity"), "0.15") << "provenance has one spelling of a number";
    EXPECT_EQ(settings.integer("layers"), -2);
    EXPECT_EQ(settings.word("gradient"), "normalised");
}

TEST(Settings, TakesTheEndsOfAnInterval) {
    EXPECT_EQ(refusal({{"viscosity", "0"}, {"layers", "-2"}}), "");
    EXPECT_EQ(refusal({{"viscosity", "1.5"}, {"layers", "8"}}), "");
}

TEST(Settings, RefusesAnUnknownKeyAndNamesTheKnownOnes) {
    expect_names(refusal({{"viscocity", "1"}}), {"viscocity", "viscosity, layers, gradient"});
}

TEST(Settings, RefusesANumberOutOfItsInterval) {
    for (const char* text : {"-1e-9", "1.5000001", "1e300", "-0.1"}) {
        expect_names(refusal({{"viscosity", text}}), {"viscosity", text, "a number from 0 to 1.5"});
    }
    for (const char* text : {"-3", "9"}) {
        expect_names(refusal({{"layers", text}}), {"layers", text, "an integer from -2 to 8"});
    }
}

TEST(Settings, RefusesAFractionWhereAnIntegerIsWanted) {
    for (const char* text : {"2.5", "-0.5", "1e-3"}) {
        expect_names(refusal({{"layers", text}}), {"layers", text, "an integer from -2 to 8"});
    }
    EXPECT_EQ(refusal({{"layers", "2e0"}}), "") << "2e0 is an integer";
}

TEST(Settings, RefusesTextThatIsNoFiniteNumber) {
    for (const char* text : {"", " ", "one", "nan", "-nan", "inf", "-inf", "infinity", "1e999", "1 ", " 1",
                             "1x", "1,0", "0x1", "1e", "--1", "1.0.0", "1;", "1\n"}) {
        expect_names(refusal({{"viscosity", text}}),
                     {"viscosity", "'" + std::string(text) + "'", "finite number"});
        expect_names(refusal({{"layers", text}}), {"layers", "'" + std::string(text) + "'", "finite number"});
    }
}

TEST(Settings, RefusesAnUnknownWordAndNamesTheKnownOnes) {
    for (const char* text : {"", "Plain", "plain ", "plai", "normalised,plain"}) {
        expect_names(refusal({{"gradient", text}}),
                     {"gradient", "'" + std::string(text) + "'", "one of plain, normalised"});
    }
}

TEST(Settings, RefusesADeclarationThatContradictsItself) {
    EXPECT_THROW(Settings({Key::number("a", 2, 0, 1, "1", "")}, {}), UserError);
    EXPECT_THROW(Settings({Key::word("a", "c", {"a", "b"}, "")}, {}), UserError);
}

TEST(Settings, TreatsAnUndeclaredKeyInTheProgramAsAProgrammingError) {
    const Settings settings(keys, {});
    EXPECT_THROW(settings.number("density"), std::logic_error);
    EXPECT_THROW(settings.word("density"), std::logic_error);
    EXPECT_THROW(settings.number("gradient"), std::logic_error) << "a word is no number";
}

TEST(ParseNumber, NamesWhatItWasFor) {
    EXPECT_EQ(parse_number("-2.5e-3", "anything"), -0.0025);
    try {
        parse_number("2.5e-3m", "the length of row 7");
        FAIL() << "accepted";
    } catch (const UserError& error) {
        expect_names(error.what(), {"the length of row 7", "'2.5e-3m'"});
    }
}

TEST(Shortest, ReadsBackAsTheSameNumber) {
    scenes::Random random(1);
    for (int draw = 0; draw < 100000; ++draw) {
        // all exponents alike
        const double value = std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-1073, 1024)));
        const double back = parse_number(shortest(value), "value");
        ASSERT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value)) << shortest(value);
    }
    for (const double value : {0.0, -0.0, 5e-324, -2.2250738585072014e-308, 1.7976931348623157e308}) {
        const double back = parse_number(shortest(value), "value");
        EXPECT_EQ(std::bit_cast<std::uint64_t>(back), std::bit_cast<std::uint64_t>(value));
    }
}

TEST(Shortest, HasNoNeedlessDigits) {
    EXPECT_EQ(shortest(0.1), "0.1");
    EXPECT_EQ(shortest(1), "1");
    EXPECT_EQ(shortest(-1e-5), "-1e-05");
    EXPECT_EQ(shortest(2. / 3), "0.6666666666666666");
}

TEST(FindByName, NamesTheAcceptedOnes) {
    const Key first = Key::integer("one", 0, 0, 1, "");
    const Key second = Key::integer("two", 0, 0, 1, "");
    const std::vector<const Key*> entries{&first, &second};
    EXPECT_EQ(&find_by_name(entries, "two", "kind"), &second);
    EXPECT_EQ(names_of(entries), "one, two");
    try {
        find_by_name(entries, "three", "kind");
        FAIL() << "found";
    } catch (const UserError& error) {
        expect_names(error.what(), {"kind", "'three'", "one, two"});
    }
}

} // namespace
} // namespace sphvv::solver
