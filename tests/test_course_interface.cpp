/** @file test_course_interface.cpp
 * Values that a Graph can't keep are refused in the course's words. */
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

#include "tests/TestFolder.hpp"

namespace {

TEST(Values, ThatNoGraphCanKeepAreRefusedInASentence) {
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

}  // namespace
