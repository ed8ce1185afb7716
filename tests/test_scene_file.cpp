// Words.hpp, Model.hpp, SceneFile.hpp: what a scene file says, and every way in
// which it can be wrong.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "CME212/Mesh.hpp"
#include "CME212/Util.hpp"
#include "lab/methods/Methods.hpp"
#include "lab/scenes/Compose.hpp"
#include "lab/scenes/Fields.hpp"
#include "lab/scenes/KeyValues.hpp"
#include "lab/scenes/SceneFile.hpp"
#include "lab/scenes/StoredScenes.hpp"
#include "lab/scenes/Words.hpp"
#include "tests/ReadParts.hpp"
#include "tests/Stages.hpp"
#include "tests/TestFolder.hpp"

using namespace lab;

namespace {

// ---------------------------------------------------------------------- Words

/** A part of one word of each kind. */
struct Example {
  double length = 7;
  std::optional<double> factor;
  Point at = Point(1, 1, 1);
  bool bend = true;
  Words words() {
    return {"pin",
            {{"x", &length, Word::Range::positive},
             {"at", &at},
             {"factor", &factor, Word::Range::not_negative},
             {"bend", &bend}},
            length == 13 ? "has bad luck" : nullptr};
  }
};

/** The error that the words cause. */
std::string complaint(const std::string& text) {
  Example e;
  return error_of<SceneError>(
      [&] { read_words(text, [&e] { return e.words(); }); });
}

TEST(Words, SetTheMembersThatTheyName) {
  Example e, usual;
  read_words(" at 1 -2e1  .5 factor 0\t", [&e] { return e.words(); });
  EXPECT_EQ(e.at, Point(1, -20, 0.5));
  EXPECT_EQ(e.factor, 0);
  EXPECT_EQ(e.length, 7);
  EXPECT_FALSE(e.bend);
  EXPECT_EQ(written(e.words(), usual.words()), "at 1 -20 0.5 factor 0");
  EXPECT_EQ(written(usual.words(), usual.words()), "bend");
}

TEST(Words, SayWhatIsWrong) {
  for (const char* right : {"x 1 at 1 2 3", ""})
    EXPECT_EQ(complaint(right), "");
  for (const auto& [text, what] :
       std::vector<std::pair<std::string, const char*>>{
           {"y 1", "has \"y\", expected one of x, at, factor, bend"},
           {"x 1 y",
            "has \"y\", expected a number or one of x, at, factor, bend"},
           {"1", "has \"1\", expected one of x, at, factor, bend"},
           {"x 1 x 2", "has x twice"},
           {"at 1", "has 1 number after at, expected 3"},
           {"x 1 2", "has 2 numbers after x, expected 1"},
           {"at 1 2", "has 2 numbers after at, expected 3"},
           {"bend 1", "has 1 number after bend, expected 0"},
           {"x 0", "has x 0, expected more than 0"},
           {"x 1e-9 factor -1", "has factor -1, expected at least 0"},
           {"x 13", "has bad luck"}})
    EXPECT_EQ(complaint(text), "--pin \"" + text + "\" " + what);
  for (const char* number : {"nan", "inf", "-inf", "1e999", "1x", "0x", "--1"})
    EXPECT_NE(complaint(std::string("x ") + number), "") << number;
}

// ---------------------------------------------------------------------- Parts

TEST(Parts, AreWhatTheirWordsSay) {
  EXPECT_EQ(read_sheet("at 1 2 3 u 0 2 0 v 0 0 4 nodes 5 7"),
            (Sheet{{1, 2, 3}, {0, 2, 0}, {0, 0, 4}, {5, 7}, {}}));
  EXPECT_EQ(read_sheet("velocity 0 1 -2").velocity, Point(0, 1, -2));
  const Region r = read_region("to 1 0 2 from 0 1 2 mass-factor 50");
  EXPECT_EQ(r.mass, 50);
  EXPECT_EQ(r.stiffness, 1);
  for (const Point& p : {Point(0.5, 0.5, 2 + 0.9e-9), Point(1, 1, 2)})
    EXPECT_TRUE(r.box.holds(p)) << p;
  for (const Point& p : {Point(0.5, 1.1, 2), Point(0.5, 0.5, 2 + 1.1e-9)})
    EXPECT_FALSE(r.box.holds(p)) << p;

  const Pin p = read_pin("x 0.5 z 1 velocity 0 1 0 until 2");
  for (const Point& q : {Point(0.5, 77, 1), Point(0.5 + 0.9e-9, 77, 1)})
    EXPECT_LT(p.distance(0, q), Pin::near) << q;
  for (const Point& q : {Point(0.5 + 1.1e-9, 77, 1), Point(0.5, 77, 1.1)})
    EXPECT_GE(p.distance(0, q), Pin::near) << q;
  EXPECT_EQ(p.motion.velocity, Point(0, 1, 0));
  EXPECT_EQ(p.motion.until, 2);

  const Wall w = read_plane("at 0 0 1 normal 0 3 4 friction 0.5");
  EXPECT_LT(norm(w.out() - Point(0, 0.6, 0.8)), 1e-15);
  EXPECT_EQ(w.friction, 0.5);
  const Solid ball = read_sphere("radius 2 at 3 2 1");
  EXPECT_EQ(ball.ball.center, Point(3, 2, 1));
  EXPECT_EQ(ball.ball.radius, 2);
  EXPECT_EQ(ball.friction, 0);
  EXPECT_EQ(read_tear("").radius, Ball().radius);
  EXPECT_EQ(read_self_collision("thickness 0.1").thickness, 0.1);
  EXPECT_TRUE(read_edges("sides bend").bend);
  EXPECT_FALSE(read_edges("sides bend").diagonals);
  EXPECT_EQ(read_measure("max-stretch"), Measure::max_stretch);
  const Box v = read_view("to 1 2 3 from 0 0 -1");
  EXPECT_EQ(v.from, Point(0, 0, -1));
  EXPECT_EQ(v.to, Point(1, 2, 3));
  EXPECT_EQ(read_time_step("auto").rule, StepRule::safe);
  EXPECT_EQ(read_time_step("auto:sharp").rule, StepRule::sharp);
  EXPECT_EQ(read_time_step("auto").gain, 0.1);
  EXPECT_EQ(read_time_step("auto:0.02").gain, 0.02);
  EXPECT_EQ(read_time_step("auto:sharp:1").rule, StepRule::sharp);
  EXPECT_EQ(read_time_step("2e-3").dt, 0.002);
  EXPECT_TRUE(read_time_step("2e-3").fixed());
  EXPECT_EQ(read_method("tr-bdf2"), &table::tr_bdf2);
  EXPECT_EQ(read_wind("velocity 3 0 1").velocity, Point(3, 0, 1));
  const Pin turned = read_pin("x 0 turn 0 2 0 about 0 1 0 until 1");
  EXPECT_EQ(turned.motion.turn, Point(0, 2, 0));
  EXPECT_EQ(turned.motion.about, Point(0, 1, 0));
}

TEST(Parts, KnowTheOtherNamesOfAMethod) {
  for (const auto& [name, method] :
       {std::pair("explicit-euler", "forward-euler"),
        std::pair("semi-implicit-euler", "symplectic-euler"),
        std::pair("backward-euler", "implicit-euler"),
        std::pair("velocity-verlet", "verlet"),
        std::pair("leapfrog", "verlet")})
    EXPECT_EQ(read_method(name)->info.name, method);
  for (const auto& [name, meant] :
       {std::pair("newmark", "implicit-midpoint"),
        std::pair("trapezoidal", "implicit-midpoint"), std::pair("pbd", "xpbd"),
        std::pair("leapfrogg", "leapfrog"), std::pair("RK4", "rk4"),
        std::pair("Midpoint", "implicit-midpoint"), std::pair("PBD", "xpbd"),
        std::pair("Velocity Verlet", "verlet")})
    EXPECT_EQ(error_of([&, name = name] { read_method(name); }),
              std::string("--method is ") + name +
                  ", expected a name of --list-methods: did you mean " + meant +
                  "?");
}

// In the documented order, without what is the default, with all digits; and
// read again they are the same part.
TEST(Parts, HaveOneTextEach) {
  using Pairs = std::initializer_list<std::pair<const char*, const char*>>;
  auto expect = [](auto read, Pairs all) {
    for (const auto& [text, words] : all)
      for (const char* either : {text, words})
        EXPECT_EQ(to_words(read(either)), words);
  };
  expect(read_edges, {{"bend sides", "sides bend"},
                      {"diagonals sides", "sides diagonals"}});
  expect(read_sheet,
         {{"", ""},
          {"nodes 3 20 at 0 0 1e-1", "at 0 0 0.1 nodes 3 20"},
          {"v 0 2 0 u 1 0 0 at 0 0 0 nodes 20 20", "v 0 2 0"},
          {"velocity 0 0 -3 nodes 3 3", "nodes 3 3 velocity 0 0 -3"}});
  expect(read_region,
         {{"stiffness-factor 1e4 to 1 1 0 from 0 0 0",
           "from 0 0 0 to 1 1 0 stiffness-factor 10000"},
          {"from 0 0 0 to 1 1 0 mass-factor 1 stiffness-factor 0",
           "from 0 0 0 to 1 1 0 stiffness-factor 0"},
          {"from 0 0 0 to 1 1 0 mass-factor 1",
           "from 0 0 0 to 1 1 0 stiffness-factor 1"},
          {"from 0 0 0 to 1 1 0 stiffness-factor 2 mass-factor .5",
           "from 0 0 0 to 1 1 0 mass-factor 0.5 stiffness-factor 2"}});
  expect(read_pin,
         {{" y 0\tx 1 until 0.5 velocity 0 0 -1",
           "x 1 y 0 velocity 0 0 -1 until 0.5"},
          {"z 0.30000000000000004 velocity 0 0 0", "z 0.30000000000000004"}});
  expect(read_plane,
         {{"friction 0 normal 0 0 1 at 0 0 -.75", ""},
          {"friction .5 normal 0 3 4", "normal 0 3 4 friction 0.5"}});
  expect(read_sphere,
         {{"radius 0.15 friction 0.5 at 1 2 3", "at 1 2 3 friction 0.5"},
          {"velocity 0 0 1 radius 2", "radius 2 velocity 0 0 1"}});
  expect(read_tear, {{"at 0.5 0.5 -0.5 radius 0.15", ""}});
  expect(read_self_collision,
         {{"friction 0.25 thickness 0.1", "thickness 0.1 friction 0.25"}});
  expect(read_view, {{"to 1 1 1 from 0 0 0", "from 0 0 0 to 1 1 1"}});
  expect(read_time_step, {{"1e-3", "0.001"},
                          {"auto", "auto"},
                          {"auto:sharp", "auto:sharp"},
                          {"auto:0.1", "auto"},
                          {"auto:2e-2", "auto:0.02"},
                          {"auto:sharp:.02", "auto:sharp:0.02"}});
}

TEST(Parts, RefuseWhatMakesNoSense) {
  const auto wrong = [](auto read, const char* text) {
    const std::string error = error_of<SceneError>([&] { read(text); });
    return error.substr(error.find(" has"));
  };
  EXPECT_EQ(wrong(read_sheet, "nodes 5 2.5"),
            " has nodes 2.5, expected 1 to 10000");
  EXPECT_EQ(wrong(read_pin, "until 2 velocity 1 0 0"),
            " has none of x, y, z, node");
  EXPECT_EQ(wrong(read_pin, "x 1 until 2"), " has no velocity");
  EXPECT_EQ(wrong(read_region, "from 0 0 0 to 1 1 1"),
            " has none of mass-factor, stiffness-factor");
  EXPECT_EQ(wrong(read_edges, "bend"), " has no sides");
  const auto refuses = [](auto read, std::initializer_list<const char*> all) {
    for (const char* text : all) EXPECT_THROW(read(text), SceneError) << text;
  };
  refuses(read_sheet, {"nodes 0 5", "nodes 5 10001", "u 1 0 0 v 2 0 0"});
  EXPECT_NO_THROW(read_sheet("nodes 2 10000"));
  refuses(read_region,
          {"from 0 0 0 mass-factor 2", "from 0 0 0 to 1 1 1 mass-factor 0",
           "from 0 0 0 to 1 1 1 stiffness-factor -1"});
  refuses(read_pin, {"velocity 1 0 0", "x 1 velocity 1 0 0 until -1"});
  refuses(read_plane, {"normal 0 0 0", "friction -0.1"});
  refuses(read_sphere, {"radius 0"});
  refuses(read_tear, {"radius 1 friction 1"});
  refuses(read_self_collision, {"friction 1", "thickness 0"});
  refuses(read_edges, {"diagonals", ""});
  refuses(read_measure, {"max_stretch"});
  refuses(read_view, {"from 0 0 0", "from 0 0 1 to 0 0 1"});
  refuses(read_time_step, {"auto:", "auto:0", "auto:2", "auto:nan", "auto:0.1x",
                           "auto:sharp:", "auto:0.1:sharp", "automatic", "0"});
}

// ----------------------------------------------------------------------- TOML

using Values = std::vector<std::string>;

/** The values of the one key in @a text, or what is wrong with it. */
Values values_of(const std::string& text) {
  Values values;
  try {
    each_key_value(text, "f", [&](const KeyValue& found, std::size_t line) {
      EXPECT_EQ(found.key, "k");
      EXPECT_EQ(line, 1u);
      values = found.values;
    });
  } catch (const InputError& e) {
    values = {"error", e.what()};
  }
  return values;
}

TEST(KeyValues, AreTextsNumbersAndLists) {
  EXPECT_EQ(values_of("k=1"), Values{"1"});
  EXPECT_EQ(values_of(" k\t= 'x 0  y 1' # c\r\n"), Values{"x 0  y 1"});
  EXPECT_EQ(values_of("\"k\" = \" a # b \" # c"), Values{" a # b "});
  EXPECT_EQ(values_of("k = ''"), Values{""});
  EXPECT_EQ(values_of("k = 'C:\\new \"x\"'"), Values{"C:\\new \"x\""});
  EXPECT_EQ(values_of("k = [ \"a\" , 'b,]', 3,] # c"),
            (Values{"a", "b,]", "3"}));
  EXPECT_EQ(values_of("k = [  # c\r\n  \"a\",\r\n\r\n  # d\r\n  'b'\r\n]\r\n"),
            (Values{"a", "b"}));
  EXPECT_EQ(values_of("k = \"\"\"\nx 0 \\\n  y 1\"\"\""), Values{"x 0 y 1"});
  EXPECT_EQ(values_of("k = '''\na\nb'''"), Values{"a\nb"});
  EXPECT_EQ(values_of("k = []"), Values{});
  EXPECT_EQ(values_of("k = true"), Values{"true"});
  EXPECT_EQ(values_of("k = \"\\\"\\\\\\n\\t\\u00e9\\U0001F600\\u20AC\""),
            Values{"\"\\\n\t\xC3\xA9\xF0\x9F\x98\x80\xE2\x82\xAC"});
  EXPECT_EQ(values_of("\xEF\xBB\xBFk = 1"), Values{"1"});
}
TEST(KeyValues, HaveNumbersAsTextThatIsReadBack) {
  EXPECT_EQ(values_of("k = [0.1, 1e-3, -0.0, +9, 1_000, 0x10, 6.02e23]"),
            (Values{"0.1", "0.001", "-0", "9", "1000", "16", "6.02e+23"}));
  EXPECT_EQ(values_of("k = [inf, -inf]"), (Values{"inf", "-inf"}));
}
TEST(KeyValues, AreInTheOrderOfTheirLines) {
  std::string all;
  each_key_value("b = 1\n\na = [\n2]\nc = 3", "f",
                 [&](const KeyValue& found, std::size_t line) {
                   all += found.key + std::to_string(line);
                 });
  EXPECT_EQ(all, "b1a3c5");
}
TEST(KeyValues, SayWhatIsWrong) {
  auto error = [](const std::string& text) { return values_of(text).at(1); };
  EXPECT_EQ(error("k = x 0"),
            "f:1: \"k = x 0\" is not TOML (value: could not determine value "
            "type), expected KEY = VALUE, text in quotes");
  for (const char* wrong : {"k = \"a", "k = [1, 2", "k = 1]", "k = a\"b\"",
                            "k = \"a\" b", "k = # 1", "k", "= 1", "k = \"\\q\"",
                            "k = \"\xFF\"", "k = 99999999999999999999"}) {
    const std::string what = error(wrong);
    EXPECT_TRUE(what.starts_with("f:1: \"")) << what;
    EXPECT_TRUE(what.ends_with("), expected KEY = VALUE, text in quotes"))
        << what;
  }
  EXPECT_EQ(error("k = \"a\\u0000\""),
            "f:1: k has the character 0, expected another text");
  const std::string expected = ", expected text, a number or a list of them";
  EXPECT_EQ(error("k = [[1]]"), "f:1: k has a list in its list" + expected);
  EXPECT_EQ(error("[k]\na = 1"), "f:1: has a table, expected KEY = VALUE");
  EXPECT_EQ(error("k = [\n'['\n]\n [[[a"),
            "f:4: has a table, expected KEY = VALUE");
  EXPECT_EQ(error("k = {a = 1}"), "f:1: has a table, expected KEY = VALUE");
  EXPECT_EQ(error("k = [1, }"), "f:1: has a table, expected KEY = VALUE");
  for (const char* letter : {"\xC3\xA9", "\xE3\x80\x80", "\xFF"})
    EXPECT_EQ(error("# \xC3\xA9\nk = " + std::string(letter)),
              "f:2: has a letter out of quotes that is not ASCII, expected KEY "
              "= VALUE");
  EXPECT_EQ(error("k.a = 1"), "f:1: k is a table" + expected);
  EXPECT_EQ(error("k = 1979-05-27"), "f:1: k is a date or a time" + expected);
  const std::string control =
      "f:1: \"?[2J" + std::string(56, 'a') + "...\" is not TOML (";
  EXPECT_TRUE(error("\x1B[2J" + std::string(99, 'a')).starts_with(control));
}

// Tables in tables end as an error before the stack is too small for them.
TEST(KeyValues, AreNotDeep) {
  for (const char* part : {"[", "{a=", "a.", "[a.", "\"a\".", "'''\n.", "[}"}) {
    std::string deep;
    for (int i = 0; i < 100'000; ++i) deep += part;
    for (const std::string& text : {"k = " + deep, deep, deep + "a = 1"}) {
      const Values found = values_of(text);
      ASSERT_EQ(found.size(), 2u) << part;
      EXPECT_TRUE(found[1].starts_with("f:")) << found[1];
    }
  }
  EXPECT_EQ(values_of("k = \"" + std::string(2000, '.') + "\" # " +
                      std::string(2000, '.')),
            Values{std::string(2000, '.')});
}

/** Any characters up to U+00FF but 0, which no name of a file has. */
rc::Gen<std::string> any_text() {
  return rc::gen::map(
      rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 256)),
      [](const std::vector<int>& all) {
        std::string text;
        for (int c : all) {
          if (c >= 0x80) text += char(0xC0 | c >> 6);
          text += char(c < 0x80 ? c : 0x80 | (c & 0x3F));
        }
        return text;
      });
}

// Whatever is read, it is a value or an error with its line. Made of what the
// grammar knows, most of it gets far.
RC_GTEST_PROP(KeyValues, EndWellWhateverIsRead, ()) {
  const auto text = *rc::gen::container<std::string>(
      rc::gen::oneOf(rc::gen::element('k', '=', '"', '\'', '[', ']', ',', '\\',
                                      'u', '0', '#', '\n', ' ', '{', '.', '}'),
                     rc::gen::arbitrary<char>()));
  std::string error = "f:";
  try {
    each_key_value("k = " + text, "f", [](auto& found, std::size_t line) {
      RC_ASSERT(line > 0 && !found.key.empty());
    });
  } catch (const InputError& e) {
    error = e.what();
  }
  RC_ASSERT(error.starts_with("f:") && error.size() < 250);
  for (unsigned char c : error) RC_ASSERT(c >= 0x20 && c != 0x7F);
}

// ----------------------------------------------------------------------- Files

class SceneFile : public ::testing::Test {
 protected:
  const CME212::TestFolder folder;
  const std::string name = folder / "scene.toml";
  Model load(const std::string& text) {
    std::ofstream(name) << text;
    return load_model(name);
  }
  /** The error of a file, without its name. */
  std::string complaint(const std::string& text) {
    try {
      load(text);
    } catch (const SceneFileError& e) {
      const std::string what = e.what();
      EXPECT_TRUE(begins(what, name + ':'));
      return what.substr(name.size() + 1);
    }
    return "";
  }
};

TEST_F(SceneFile, SetsWhatItNames) {
  const Model m = load(
      "# a scene\n"
      "sheet = [\"nodes 3 3\", \"at 0 0 1 nodes 2 2\"]  # two\n"
      "\n"
      "pin=\"x 0\" # held\n"
      "  density =  2.5\n"
      "gravity = [0, 0.0, -2]\nwind = [1, 0, 0]\ndrag = 1\n"
      "dt = \"auto\"\n"
      "t-end = 1\n");
  EXPECT_EQ(m.sheets, (std::vector{read_sheet("nodes 3 3"),
                                   read_sheet("at 0 0 1 nodes 2 2")}));
  EXPECT_EQ(m.name, "scene");
  EXPECT_EQ(m.material.density, 2.5);
  EXPECT_EQ(m.gravity, 2);
  EXPECT_EQ(m.wind->velocity, Point(1, 0, 0));
  EXPECT_FALSE(m.material.modulus);
  EXPECT_EQ(m.step.rule, StepRule::safe);
  EXPECT_EQ(m.t_end, 1);
  EXPECT_EQ(m.stiffness, 100);
}

RC_GTEST_FIXTURE_PROP(SceneFile, IsReadBackWhateverItsNamesHold, ()) {
  Model m;
  m.nodes = "/" + *any_text(), m.tets = "/" + *any_text();
  m.pins = {Pin()};
  m.pins[0].x = *rc::gen::arbitrary<double>();
  RC_PRE(std::isfinite(*m.pins[0].x));
  const Model n = load(to_scene_file(m));
  RC_ASSERT(n.nodes == m.nodes && n.tets == m.tets && n.pins == m.pins);
}
TEST(MeshName, IsInUtf8) {
  Model m;
  set_field(m, "nodes", {"\xC3\xA9"});
  EXPECT_EQ(m.nodes, "\xC3\xA9");
  EXPECT_THROW(set_field(m, "nodes", {"a\xFF"}), SceneError);
}
TEST_F(SceneFile, NamesFilesRelativeToItself) {
  EXPECT_EQ(load("nodes = \"sub/a.nodes\"\ntets = \"../b.tets\"\n").nodes,
            folder / "sub/a.nodes");
  EXPECT_EQ(load("nodes = \"/a.nodes\"\ntets = \"b\"\n").nodes, "/a.nodes");
  // A dump has whole paths, so that it can be put anywhere.
  Model m;
  m.nodes = "a", m.tets = "b";
  EXPECT_EQ(load(to_scene_file(m)).nodes, std::filesystem::absolute("a"));
}
TEST(Origins, AreTheLinesOfAFile) {
  const Origins at = {"s.toml", {{"pin", 3}, {"tear-strain", 4}}};
  EXPECT_EQ(at.of("--pin \"x 3\" holds no node", "-"), "s.toml:3: ");
  EXPECT_EQ(at.of("--tear-strain is 0", "-"), "s.toml:4: ");
  EXPECT_EQ(at.of("--tear is 0", "-"), "-");
  EXPECT_EQ(at.of("no memory", "-"), "-");
}

TEST_F(SceneFile, SaysWhereItIsWrong) {
  const std::string sheet = "sheet = [\"nodes 3 3\"]\n";
  EXPECT_EQ(complaint(sheet), "");
  for (const auto& [key, hint] :
       {std::pair("colour", ""), std::pair("config", ""),
        std::pair("gravty", ": did you mean gravity?"),
        std::pair("mass", ": expected density, or masses in a .net file"),
        std::pair("substeps",
                  ": expected dt: xpbd has ten substeps a step, "
                  "other methods have none")})
    EXPECT_EQ(complaint(sheet + key + " = 3\n"),
              std::string("2: unknown key ") + key + hint);
  EXPECT_EQ(complaint(sheet + "t-end = 1\n\nt-end = 2\n").substr(0, 28),
            "4: \"t-end = 2\" is not TOML (");
  EXPECT_EQ(complaint(sheet + "t-end = \"long\"\n"),
            "2: --t-end is long, expected a time [s], 0 or more");
  EXPECT_EQ(complaint(sheet + "t-end = [1, 2]\n"),
            "2: --t-end is 1 2, expected a time [s], 0 or more");
  EXPECT_EQ(complaint("pin = [\"q 3\"]\n" + sheet),
            "1: --pin \"q 3\" has \"q\", expected one of x, y, z, node, "
            "velocity, turn, about, until");
  EXPECT_EQ(complaint(sheet + "tear = \"radius 1\"\ntear-strain = -1\n"),
            "3: --tear-strain is -1, expected a strain above 0");
  EXPECT_EQ(complaint(sheet + "modulus = 1\nstiffness = 1\n"),
            "2: --modulus excludes --stiffness");
}

TEST_F(SceneFile, RefusesValuesOutOfRange) {
  const auto wrong = [this](std::string line) {
    return complaint("sheet = [\"nodes 3 3\"]\n" + line + '\n');
  };
  const auto all_wrong = [&](std::initializer_list<const char*> all) {
    for (const char* line : all) EXPECT_NE(wrong(line), "") << line;
  };
  all_wrong({"self-collision = \"friction 1\"", "edges = \"diagonals\"",
             "drag = 1\ndamping = 1", "measure = \"beauty\"",
             "method = \"magic\""});
  all_wrong({"tear-strain = 0", "tolerance = nan", "stiffness = -1",
             "tolerance = 0", "nodes = \"x\"", "dt = \"soon\"", "gravity = inf",
             "density = -1", "modulus = -1", "damping = -1", "density = 0",
             "t-end = inf", "dt = \"-1\"", "t-end = -1", "drag = -1",
             "dt = \"\""});
  for (const char* line :
       {"density = 1e-9", "modulus = 0", "drag = 0", "tear-strain = 1e-9",
        "tolerance = 1e-9", "gravity = -1", "stiffness = 0", "t-end = 0"})
    EXPECT_EQ(wrong(line), "") << line;
  EXPECT_EQ(complaint("t-end = 1\n"),
            " --nodes is missing: expected files NODES and TETS, --net or "
            "--sheet");
}

TEST(SceneFiles, ThatAreNoneAreToldApart) {
  EXPECT_THROW(load_model("no/such/scene.toml"), SceneFileError);
  EXPECT_THROW(load_model("."), SceneFileError);
}

TEST(StoredScenes, AreTheFilesOfThisRepository) {
  for (const auto& [all, folder] :
       {std::pair(stored_scenes(), "data/scenes"),
        std::pair(failing_scenes(), "data/scenes/failures")}) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      files += entry.path().extension() == ".toml";
    EXPECT_EQ(all.size(), files);
    for (const StoredScene& s : all) {
      const std::string file = std::string(folder) + '/' + s.name + ".toml";
      EXPECT_EQ(CME212::contents(file), s.text);
      EXPECT_TRUE(
          std::string(s.text).starts_with(std::string("# ") + s.title + '\n'))
          << file;
      const Model m = s.model(), read = load_open_model(file);
      EXPECT_EQ(to_scene_file(m), to_scene_file(read));
      EXPECT_EQ(m.name, read.name);
      EXPECT_TRUE(m.names_parts()) << file;
      if (m.sheets.empty() && m.nodes.empty()) {
        EXPECT_THROW(load_model(file), SceneFileError);
      }
    }
  }
  EXPECT_EQ(stored_scene("tear").model().tears.size(), 1u);
  EXPECT_THROW(stored_scene("none"), std::out_of_range);
}

// ------------------------------------------------------------- The assignment

TEST(Assignment, IsTheSceneFileTear) {
  const Model m = assignment_scene(), file = stage_scene("tear");
  EXPECT_EQ(to_scene_file(m), to_scene_file(file));
  EXPECT_EQ(to_scene_file(m), to_scene_file(or_assignment({})));
  EXPECT_EQ(m.name, file.name);
}
TEST(Assignment, IsWhatRunsIfNoPartIsNamed) {
  Model m;
  m.nodes = "data/grid0.nodes", m.damping = 0.1, m.step.dt = 0.002;
  const Model run = or_assignment(m);
  EXPECT_EQ(run.pins, assignment_scene().pins);
  EXPECT_EQ(run.planes, assignment_scene().planes);
  EXPECT_EQ(run.tears.size(), 1u);
  EXPECT_EQ(run.name, "tear");
  EXPECT_EQ(run.nodes, m.nodes);
  EXPECT_EQ(run.damping, 0.1);
  EXPECT_EQ(run.step.dt, 0.002);
}
// A scene file contains only the parts that it names.
TEST(Assignment, IsNoPartOfAFile) {
  const CME212::TestFolder folder;
  std::ofstream(folder / "a.toml")
      << "nodes = \"a.nodes\"\ntets = \"a.tets\"\nstiffness = 50\npin = []\n";
  const Model m = load_model(folder / "a.toml");
  EXPECT_TRUE(m.pins.empty() && m.planes.empty() && m.tears.empty());
}
TEST(Assignment, IsNotWhatRunsIfAPartIsNamed) {
  using Change = void (*)(Model&);
  for (Change name :
       {Change([](Model& m) { m.sheets = {Sheet()}; }),
        Change([](Model& m) { m.edges.bend = true; }),
        Change([](Model& m) { m.material.density = 1; }),
        Change([](Model& m) { m.material.modulus = 1; }),
        Change([](Model& m) { m.material.drag = 1; }),
        Change([](Model& m) { m.regions = {Region()}; }),
        Change([](Model& m) { m.pins = {read_pin("x 0")}; }),
        Change([](Model& m) { m.planes = {Wall()}; }),
        Change([](Model& m) { m.spheres = {Solid()}; }),
        Change([](Model& m) { m.tears = {Ball()}; }),
        Change([](Model& m) { m.tear_strain = 1; }), Change([](Model& m) {
          m.self_collision = Distance{.thickness = 1};
        })}) {
    Model m;
    name(m);
    EXPECT_EQ(to_scene_file(or_assignment(m)), to_scene_file(m));
  }
}

}  // namespace
