/** @file test_course_interface.cpp
 * Programs as they are written against the two published layouts of the
 * course's headers have to compile. */
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

#include "tests/TestFolder.hpp"

namespace {

/** Compile a program that includes and names what @a year calls its library.
 * @param viewer the name of its window   @param flag for its folder */
CME212::TestFolder::Result compile(const std::string& year,
                                   const std::string& viewer,
                                   const std::string& flag) {
  CME212::TestFolder folder;
  std::string text = R"(
    #include "YEAR/VIEWER.hpp"
    #include "YEAR/Util.hpp"
    #include "YEAR/Color.hpp"
    #include "YEAR/BoundingBox.hpp"
    #include "Graph.hpp"
    #include POINT
    template <typename V> class Mesh { V value; };  // of homework 4
    struct ByValue {
      template <typename N> YEAR::Color operator()(const N& n) const {
        return YEAR::Color::make_heat(float(n.value()));
      }
    };
    int main(int, char** argv) {
      YEAR::Clock clock;
      Graph<double, double> g;
      std::ifstream in(argv[1]);
      for (Point p; YEAR::getline_parsed(in, p);) g.add_node(p);
      YEAR::VIEWER viewer;
      auto node_map = viewer.empty_node_map(g);
      viewer.add_nodes(g.node_begin(), g.node_end(), ByValue(), node_map);
      viewer.launch();
      YEAR::sleep(YEAR::random() * clock.seconds());
    })";
  for (auto [name, value] :
       {std::pair("YEAR", year), std::pair("VIEWER", viewer),
        std::pair("POINT", year == "CS207" ? std::string("\"Point.hpp\"")
                                           : "\"CME212/Point.hpp\"")})
    for (std::size_t at; (at = text.find(name)) != text.npos;)
      text.replace(at, std::string(name).size(), value);
  std::ofstream(folder / "program.cpp") << text;
  return folder.run("c++ -std=c++20 -fsyntax-only -I. " + flag + ' ' +
                    folder / "program.cpp");
}

TEST(Layouts, AValueThatNoGraphCanKeepIsRefusedInASentence) {
  CME212::TestFolder folder;
  const char *copyable = "values of a Graph are copyable",
             *changes = "values of a Graph can change";
  for (auto [value, why] : {std::pair("std::unique_ptr<int>", copyable),
                            {"std::reference_wrapper<int>", copyable},
                            {"const int", changes}}) {
    std::ofstream(folder / "a.cpp")
        << "#include \"Graph.hpp\"\n#include <memory>"
           "\nGraph<"
        << value << ", int> g;\n";
    const auto result =
        folder.run("c++ -std=c++20 -fsyntax-only -I. " + folder / "a.cpp");
    EXPECT_LT(result.err.find(why),
              result.err.find('\n', result.err.find("error: ")))
        << result.err;
  }
}

TEST(Layouts, ProgramsOfBothCompile) {
  for (const std::string viewer : {"SDLViewer", "SFML_Viewer"}) {
    const auto result = compile("CME212", viewer, "");
    EXPECT_EQ(result.status, 0) << result.err;
  }
  const auto result = compile("CS207", "SDLViewer", "-Icourse/years");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_NE(compile("CS207", "SDLViewer", "").status, 0) << "needs the flag";
}

}  // namespace
