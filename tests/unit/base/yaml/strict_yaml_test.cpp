#include "base/yaml/strict_yaml.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "base/error.h"

namespace rubble {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// The message of the InputError that `act` throws; it must be one line.
std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "no error";
}

std::string parse_error(const std::string& text) {
  return error_of([&] { YamlMap::parse(text, "f.yaml"); });
}

TEST(StrictYaml, EveryKindOfValueIsRead) {
  const YamlMap root = YamlMap::parse(
      "n: -2.5e-1\ni: 42\nb: true\nt: some words\nq: \"5\"\nc: red\nl: [1, 2.5, -3]\nw: [a, 'b c']\n"
      "m:\n  inner: 7\nlist:\n  - {x: 1}\n  - x: 2\n",
      "f.yaml");
  EXPECT_EQ(root.number("n", {}, -1, 1), -0.25);
  EXPECT_EQ(root.integer("i", {}, 0, 100), 42);
  EXPECT_TRUE(root.boolean("b", {}));
  EXPECT_EQ(root.text("t", {}), "some words");
  EXPECT_EQ(root.text("q", {}), "5");
  EXPECT_EQ(root.choice("c", {}, {"green", "red"}), "red");
  EXPECT_EQ(root.numbers("l"), (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(root.texts("w"), (std::vector<std::string>{"a", "b c"}));
  EXPECT_EQ(root.map("m").integer("inner", {}, 0, 10), 7);
  const auto maps = root.maps("list");
  ASSERT_EQ(maps.size(), 2u);
  EXPECT_EQ(maps[0].integer("x", {}, 0, 10), 1);
  EXPECT_EQ(maps[1].integer("x", {}, 0, 10), 2);
  EXPECT_EQ(root.keys(), (std::vector<std::string>{"n", "i", "b", "t", "q", "c", "l", "w", "m", "list"}));
  EXPECT_NO_THROW(root.finish());
}

TEST(StrictYaml, AbsentKeysGiveTheFallback) {
  const YamlMap root = YamlMap::parse("a: 1\n", "f.yaml");
  EXPECT_EQ(root.number("x", 2.5, 0, 1), 2.5);
  EXPECT_EQ(root.integer("x", 3, 0, 9), 3);
  EXPECT_FALSE(root.boolean("x", false));
  EXPECT_EQ(root.text("x", "y"), "y");
  EXPECT_EQ(root.choice("x", "p", {"p", "q"}), "p");
  EXPECT_TRUE(root.numbers("x", 3).empty());
  EXPECT_TRUE(root.texts("x").empty());
  EXPECT_TRUE(root.maps("x").empty());
  EXPECT_TRUE(root.map("x").keys().empty());
  EXPECT_FALSE(root.has("x"));
}

TEST(StrictYaml, AMissingKeyIsPlacedAtItsMap) {
  const YamlMap root = YamlMap::parse("a: 1\nm:\n  x: 1\n", "f.yaml");
  EXPECT_EQ(error_of([&] { root.number("slope_deg", {}, 0, 45); }),
            "f.yaml:1:1: missing key 'slope_deg'; add 'slope_deg: <a number from 0 to 45>'");
  EXPECT_EQ(error_of([&] { root.map("m").text("y", {}); }), "f.yaml:3:3: missing key 'y'; add 'y: <text>'");
}

TEST(StrictYaml, AWrongValueIsPlacedAtTheValueWithTheRemedy) {
  const YamlMap root = YamlMap::parse(
      "n: steep\nq: '5'\ni: 1.5\nb: yes\nc: gren\nl: [1, x]\nm: 3\nk:\nt: [1]\n"
      "d: |\n  x\nbig: 1e999\nhuge: 9223372036854775808\n",
      "f.yaml");
  EXPECT_EQ(error_of([&] { root.number("n", {}, 0, 45); }), "f.yaml:1:4: 'n' is 'steep'; give a number from 0 to 45");
  EXPECT_EQ(error_of([&] { root.number("q", {}, 0, kInf); }),
            "f.yaml:2:4: 'q' is the text '5'; give a number of at least 0");
  EXPECT_EQ(error_of([&] { root.integer("i", {}, 0, 9); }),
            "f.yaml:3:4: 'i' is '1.5'; give a whole number from 0 to 9");
  EXPECT_EQ(error_of([&] { root.boolean("b", {}); }), "f.yaml:4:4: 'b' is 'yes'; give true or false");
  EXPECT_EQ(error_of([&] {
              root.choice("c", {}, {"red", "green"});
            }),
            "f.yaml:5:4: 'c' is 'gren'; give one of red, green, did you mean 'green'?");
  EXPECT_EQ(error_of([&] { root.numbers("l"); }), "f.yaml:6:8: 'l[1]' is 'x'; give a number");
  EXPECT_EQ(error_of([&] { root.numbers("l", 3); }), "f.yaml:6:8: 'l[1]' is 'x'; give a number");
  EXPECT_EQ(error_of([&] { root.map("m"); }), "f.yaml:7:4: 'm' is '3'; give a map: indented 'key: value' lines");
  EXPECT_EQ(error_of([&] { root.text("k", {}); }), "f.yaml:8:1: 'k' has no value; give text");
  EXPECT_EQ(error_of([&] { root.text("t", {}); }), "f.yaml:9:4: 't' is a list; give text");
  EXPECT_EQ(error_of([&] { root.number("d", {}, -kInf, 3); }),
            "f.yaml:10:4: 'd' is a block of text; give a number of at most 3");
  EXPECT_EQ(error_of([&] { root.number("big", {}, -kInf, kInf); }), "f.yaml:12:6: 'big' is '1e999'; give a number");
  EXPECT_EQ(error_of([&] { root.integer("huge", {}, 0, std::numeric_limits<std::int64_t>::max()); }),
            "f.yaml:13:7: 'huge' is '9223372036854775808'; give a whole number of at least 0");
}

TEST(StrictYaml, BoundsAreInclusive) {
  const YamlMap root = YamlMap::parse("a: 0\nb: 45\nc: 45.0001\n", "f.yaml");
  EXPECT_EQ(root.number("a", {}, 0, 45), 0);
  EXPECT_EQ(root.number("b", {}, 0, 45), 45);
  EXPECT_THROW(root.number("c", {}, 0, 45), InputError);
}

TEST(StrictYaml, NotANumberAndInfinityAreNoNumbers) {
  for (const char* bad : {".nan", "nan", "NaN", ".inf", "-.inf", "inf", "0x10", "1e", "1_000", "1,5", "--1", "+-1"}) {
    const YamlMap root = YamlMap::parse("a: " + std::string(bad) + "\nl: ['0']\n", "f.yaml");
    EXPECT_THROW(root.number("a", {}, -kInf, kInf), InputError) << bad;
    EXPECT_THROW(root.numbers("l"), InputError);
  }
}

TEST(StrictYaml, AListOfTheWrongLengthSaysBothLengths) {
  const YamlMap root = YamlMap::parse("start: [1, 2]\n", "f.yaml");
  EXPECT_EQ(error_of([&] { root.numbers("start", 3); }), "f.yaml:1:8: 'start' has 2 numbers; give a list of 3 numbers");
}

TEST(StrictYaml, AnUnknownKeyNamesTheNearestKnownOne) {
  const YamlMap root = YamlMap::parse("slope: 1\nsub:\n  sloep: 2\n", "yellow.yaml");
  root.number("slope", {}, 0, 9);
  const YamlMap sub = root.map("sub");
  sub.number("slope", 1.0, 0, 9);
  EXPECT_EQ(error_of([&] { root.finish(); }), "yellow.yaml:3:3: unknown key 'sloep', did you mean 'slope'?");
}

TEST(StrictYaml, AnUnknownKeyWithoutANeighbourListsTheKnownOnes) {
  const YamlMap root = YamlMap::parse("zzz: 1\n", "f.yaml");
  EXPECT_EQ(error_of([&] { root.finish(); }), "f.yaml:1:1: unknown key 'zzz'; remove it");
  root.text("height", "");
  root.text("width", "");
  EXPECT_EQ(error_of([&] { root.finish(); }), "f.yaml:1:1: unknown key 'zzz'; known here: height, width");
}

TEST(StrictYaml, FinishLooksIntoListsOfMapsThatWereHandedOut) {
  const YamlMap root = YamlMap::parse("r:\n  - name: a\n  - name: b\n    mas: 3\n", "f.yaml");
  EXPECT_EQ(error_of([&] { root.finish(); }), "f.yaml:1:1: unknown key 'r'; remove it");
  for (const YamlMap& robot : root.maps("r")) {
    robot.text("name", {});
    robot.number("mass", 1.0, 0, 9);
  }
  EXPECT_EQ(error_of([&] { root.finish(); }), "f.yaml:4:5: unknown key 'mas', did you mean 'mass'?");
}

TEST(StrictYaml, HasDoesNotCountAsReading) {
  const YamlMap root = YamlMap::parse("arena: x\n", "f.yaml");
  EXPECT_TRUE(root.has("arena"));
  EXPECT_THROW(root.finish(), InputError);
  root.text("arena", {});
  EXPECT_NO_THROW(root.finish());
}

TEST(StrictYaml, DuplicateKeysFailOnLoadingAtAnyDepth) {
  EXPECT_EQ(parse_error("a: 1\nb: 2\na: 3\n"), "f.yaml:3:1: key 'a' is given twice (first on line 1); remove one");
  EXPECT_EQ(parse_error("a:\n  - b: {c: 1, 'c': 2}\n"),
            "f.yaml:2:15: key 'c' is given twice (first on line 2); remove one");
}

TEST(StrictYaml, BrokenYamlIsPlaced) {
  EXPECT_EQ(parse_error("a: [1, 2\nb: 3\n"), "f.yaml:1:4: '[' is not closed; add ']'");
  EXPECT_EQ(parse_error("b: 1\na: {x: 1\n"), "f.yaml:2:4: '{' is not closed; add '}'");
  EXPECT_EQ(parse_error("a: \"abc\nb: 1\n"), "f.yaml:1:4: the quote is not closed");
  EXPECT_EQ(parse_error("a: 'it''s\n"), "f.yaml:1:4: the quote is not closed");
  EXPECT_EQ(parse_error("a: 1\n]\n"), "f.yaml:2:1: a closing bracket without an opening one; remove it");
  EXPECT_EQ(parse_error("a: @b\n"), "f.yaml:1:4: a value cannot start with this character; put the text in quotes");
  EXPECT_EQ(parse_error("a:\n    b: 1\n  c: 2\n"),
            "f.yaml:3:3: not in line with the keys above; indent the keys of a map alike");
  EXPECT_EQ(parse_error("a: *b\n"), "f.yaml:1:4: broken YAML: the referenced anchor is not defined");
  EXPECT_EQ(parse_error("a: 1\n---\nb: 2\n"), "f.yaml:2:1: a second document; keep one document in a file");
  EXPECT_EQ(parse_error("a: !!int 5\n"), "f.yaml:1:4: the tag 'tag:yaml.org,2002:int' means nothing here; remove it");
  EXPECT_EQ(parse_error("? [1]\n: 2\n"), "f.yaml:1:3: a key must be one word or text");
  EXPECT_EQ(parse_error("a: |\n   xx\n  yy\n"),
            "f.yaml:3:3: indented less than the first line of the block text above; indent both alike, or write '|2'");
}

TEST(StrictYaml, ATabAsIndentationIsNamed) {
  const std::string tab = ": a tab in the indentation; indent with spaces";
  EXPECT_EQ(parse_error("a:\n\tb: 1\n"), "f.yaml:2:1" + tab);
  EXPECT_EQ(parse_error("a: 1\n\tb: 1\n"), "f.yaml:2:1" + tab);
  EXPECT_EQ(parse_error("a:\n  b: 1\n  \tc: 2\n"), "f.yaml:3:3" + tab);
  EXPECT_EQ(parse_error("a:\n\t- 1\n\t- 2\n"), "f.yaml:2:1" + tab);
  EXPECT_EQ(parse_error("a:\n\tword\n"), "f.yaml:2:1" + tab);
  EXPECT_EQ(parse_error("a: |\n  x\n  \ty\n# c\n\t# c\nb: 1\n"), "no error");  // text and comments may have tabs
}

TEST(StrictYaml, WhatIsNoMapIsRefused) {
  EXPECT_EQ(parse_error(""), "f.yaml:1:1: is empty; write 'key: value' lines");
  EXPECT_EQ(parse_error("# only a comment\n"), "f.yaml:1:1: is empty; write 'key: value' lines");
  EXPECT_EQ(parse_error("- 1\n- 2\n"), "f.yaml:1:1: is no map; write 'key: value' lines");
  EXPECT_EQ(parse_error("just words\n"), "f.yaml:1:1: is no map; write 'key: value' lines");
}

TEST(StrictYaml, BinaryFilesAreRefused) {
  EXPECT_EQ(parse_error("a: x\x04y\n"), "f.yaml:1:5: control character '\\x04'; save the file as UTF-8 text");
  EXPECT_EQ(parse_error(std::string("a\0:\0", 4)),
            "f.yaml:1:2: control character '\\x00'; save the file as UTF-8 text");
}

TEST(StrictYaml, UnreadableFilesAreNamed) {
  EXPECT_NE(error_of([] { YamlMap::load("/nowhere/x.yaml"); }).find("/nowhere/x.yaml: cannot be opened"),
            std::string::npos);
  EXPECT_NE(error_of([] { YamlMap::load(testing::TempDir()); }).find("is a folder"), std::string::npos);
}

TEST(StrictYaml, ByteOrderMarkAndWindowsLineEndsChangeNothing) {
  const YamlMap root = YamlMap::parse(
      "\xef\xbb\xbf"
      "a: 1\r\nd: |\r\n  x\r\n  y\r\nb: z\r\n",
      "f.yaml");
  EXPECT_EQ(root.integer("a", {}, 0, 9), 1);
  EXPECT_EQ(root.text("d", {}), "x\ny\n");
  EXPECT_EQ(root.text("b", {}), "z");
  EXPECT_EQ(root.place("b"), "f.yaml:5:1");
}

TEST(StrictYaml, FailAtPointsIntoTheDrawing) {
  const YamlMap root = YamlMap::parse(
      "a: 1\nfloor: |  # the ground\n  ####\n  #?.#\n  ####\n"
      "list:\n  - deep: |2\n        ..x\n      .x\nfolded: >\n  a\n  b\nplain: ab?d\nquoted: \"ab?d\"\nblank: |\n\n   "
      "?\n",
      "f.yaml");
  EXPECT_EQ(error_of([&] { root.fail_at("floor", 1, 1, "bad glyph"); }), "f.yaml:4:4: bad glyph");
  EXPECT_EQ(error_of([&] { root.fail_at("floor", 0, 0, "bad glyph"); }), "f.yaml:3:3: bad glyph");
  EXPECT_EQ(root.text("floor", {}), "####\n#?.#\n####\n");
  const YamlMap item = root.maps("list")[0];
  EXPECT_EQ(item.text("deep", {}), "  ..x\n.x\n");
  EXPECT_EQ(error_of([&] { item.fail_at("deep", 0, 4, "x"); }), "f.yaml:8:11: x");
  EXPECT_EQ(error_of([&] { item.fail_at("deep", 1, 1, "x"); }), "f.yaml:9:8: x");
  EXPECT_EQ(error_of([&] { root.fail_at("folded", 1, 0, "x"); }), "f.yaml:10:9: x");
  EXPECT_EQ(error_of([&] { root.fail_at("plain", 0, 2, "x"); }), "f.yaml:13:10: x");
  EXPECT_EQ(error_of([&] { root.fail_at("quoted", 0, 2, "x"); }), "f.yaml:14:12: x");
  EXPECT_EQ(root.text("blank", {}), "\n?\n");
  EXPECT_EQ(error_of([&] { root.fail_at("blank", 1, 0, "x"); }), "f.yaml:17:4: x");
  EXPECT_EQ(error_of([&] { root.fail_at("absent", 1, 0, "x"); }), "f.yaml:1:1: x");
}

TEST(StrictYaml, FailPointsAtTheKeyAndStaysOneLine) {
  const YamlMap root = YamlMap::parse("a: 1\nm:\n  b: 2\n", "f.yaml");
  EXPECT_EQ(error_of([&] { root.map("m").fail("b", "two\nlines"); }), "f.yaml:3:3: two\\nlines");
  EXPECT_EQ(error_of([&] { root.map("m").fail("", "x"); }), "f.yaml:3:3: x");
  EXPECT_EQ(root.place("m"), "f.yaml:2:1");
  EXPECT_EQ(root.place(), "f.yaml:1:1");
}

TEST(StrictYaml, ColumnsCountBytes) {
  EXPECT_EQ(parse_error("{\xc3\xa4: 1, b: 1, b: 2}\n"),
            "f.yaml:1:15: key 'b' is given twice (first on line 1); remove one");
}

TEST(StrictYaml, AnAliasIsACopy) {
  const YamlMap root = YamlMap::parse("a: &m {x: 1}\nb: *m\n", "f.yaml");
  EXPECT_EQ(root.map("a").integer("x", {}, 0, 9), 1);
  root.map("b");
  EXPECT_THROW(root.finish(), InputError);  // b.x was not read
  EXPECT_EQ(root.map("b").integer("x", {}, 0, 9), 1);
  EXPECT_NO_THROW(root.finish());
  EXPECT_EQ(parse_error("a: &x [1, *x]\n"), "f.yaml:1:11: an alias that stands inside the value it names");
}

TEST(StrictYaml, ExplodingDocumentsAreRefused) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int j = 0; j < 10; ++j) bomb += (j == 0 ? "" : ", ") + before;
    bomb += "]\n";
  }
  EXPECT_NE(parse_error(bomb).find("more than 200000 values"), std::string::npos);
  EXPECT_NE(parse_error("a: " + std::string(100000, '[')).find("f.yaml:1:"), std::string::npos);
}

TEST(StrictYaml, SetOverridesAndAddsAndNamesItselfInErrors) {
  YamlMap root = YamlMap::parse("seed: 1\nrobot:\n  mass: 20\nlist:\n  - {x: 1}\n", "f.yaml");
  root.set("seed", "7");
  root.set("robot.mass", "heavy");
  root.set("robot.laser.range", "[1, 2, 3]");
  root.set("new.inner", "{a: 1, b: text}");
  root.set("list.0.x", "5");
  EXPECT_EQ(root.integer("seed", {}, 0, 9), 7);
  EXPECT_EQ(root.maps("list")[0].integer("x", {}, 0, 9), 5);
  EXPECT_EQ(root.map("robot").map("laser").numbers("range", 3), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(root.map("new").map("inner").text("b", {}), "text");
  EXPECT_EQ(error_of([&] { root.map("robot").number("mass", {}, 0, 99); }),
            "--set robot.mass: 'mass' is 'heavy'; give a number from 0 to 99");
  EXPECT_EQ(error_of([&] { root.finish(); }), "--set new.inner: unknown key 'a'; known here: b");
}

TEST(StrictYaml, AMistakeInSetIsNamed) {
  YamlMap root = YamlMap::parse("seed: 1\nlist: [1, 2]\n", "f.yaml");
  EXPECT_EQ(error_of([&] { root.set("seed.x", "1"); }), "--set seed.x: 'seed' is no map; nothing can be set inside it");
  EXPECT_EQ(error_of([&] { root.set("a..b", "1"); }),
            "--set a..b: a key is empty; write '--set key=value' or '--set outer.inner=value'");
  EXPECT_EQ(error_of([&] { root.set("a", "[1"); }), "--set a: '[' is not closed; add ']'");
  EXPECT_EQ(error_of([&] { root.set("list.2", "1"); }),
            "--set list.2: 'list' is a list of 2; name an item by its number from 0, not '2'");
  root.set("speed", "");
  EXPECT_EQ(error_of([&] { root.number("speed", {}, 0, 1); }),
            "--set speed: 'speed' has no value; give a number from 0 to 1");
  root.set("sede", "3");
  root.integer("seed", {}, 0, 9);
  root.numbers("list");
  EXPECT_EQ(error_of([&] { root.finish(); }), "--set sede: unknown key 'sede', did you mean 'seed'?");
}

TEST(StrictYaml, DumpParsesToTheSameValues) {
  YamlMap root = YamlMap::parse(
      "name: 'yellow # one'\nn: 1.50\nq: \"5\"\nk:\nfloor: |\n   #..\n   .x\n\n  \nlead: |2\n    x\n  y\nm:\n  a: {}\n"
      "  l: [1, [2, 3], {x: y}]\nkeep: |+\n  t\n\nstrip: |-\n  t\nfold: >\n  a\n  b\n'odd: key': \"tab\\t\\x01\"\n",
      "f.yaml");
  root.set("extra.deep", "9");
  const std::string text = root.dump();
  const YamlMap again = YamlMap::parse(text, "dump");
  EXPECT_EQ(again.dump(), text);
  EXPECT_EQ(again.keys(), root.keys());
  for (const char* key : {"name", "q", "floor", "lead", "keep", "strip", "fold", "odd: key"})
    EXPECT_EQ(again.text(key, {}), root.text(key, {})) << text;
  EXPECT_EQ(again.number("n", {}, 0, 9), 1.5);
  EXPECT_THROW(again.number("q", {}, 0, 9), InputError);
  EXPECT_FALSE(again.has("k"));
  EXPECT_EQ(again.map("extra").integer("deep", {}, 0, 9), 9);
  EXPECT_NE(text.find("floor: |"), std::string::npos) << text;
}

}  // namespace
}  // namespace rubble
