/** @file test_output_file.cpp
 * Tests of OutputFile: what is whole, what is left alone, what is refused. */
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "CME212/OutputFile.hpp"
#include "tests/TestFolder.hpp"

namespace {

namespace fs = std::filesystem;
using CME212::contents;
using CME212::OutputFile;

class Output : public ::testing::Test {
 protected:
  const CME212::TestFolder folder;

  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  void write(const std::string& name, const std::string& text) {
    OutputFile out(name);
    out.stream() << text;
    out.commit();
  }
  std::string error(const std::string& name) {
    return error_of([&] { OutputFile out(name); });
  }
  std::vector<std::string> files() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder.path()))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  static unsigned mode(const std::string& name) {
    struct stat s = {};
    stat(name.c_str(), &s);
    return s.st_mode & 07777;
  }
};
using Names = std::vector<std::string>;

TEST_F(Output, OfTwoWritersAtOnceTheLastHasTheFileWhole) {
  const std::string name = folder / "f";
  const std::string a(100000, 'a'), b(70000, 'b');
  OutputFile first(name), second(name);
  for (std::size_t at = 0; at < a.size(); at += 1000) {
    first.stream() << a.substr(at, 1000) << std::flush;
    if (at < b.size()) second.stream() << b.substr(at, 1000) << std::flush;
  }
  EXPECT_FALSE(fs::exists(name));
  second.commit();
  EXPECT_EQ(contents(name), b);
  first.commit();
  EXPECT_EQ(contents(name), a);
  EXPECT_EQ(files(), Names{"f"});
}

TEST_F(Output, LeavesFilesThatAreNotItsOwnAlone) {
  const std::string part = file("f.part", "mine");
  write(folder / "f", "new");
  { OutputFile never_committed(folder / "g"); }
  EXPECT_EQ(contents(part), "mine");
  EXPECT_EQ(files(), (Names{"f", "f.part"}));
}

TEST_F(Output, LeavesTheOldFileUnlessItIsCommitted) {
  const std::string name = file("f", "old");
  {
    OutputFile out(name);
    out.stream() << "new" << std::flush;
    EXPECT_EQ(contents(name), "old");
  }
  EXPECT_EQ(contents(name), "old");
  EXPECT_EQ(files(), Names{"f"});
}

TEST_F(Output, KeepsPermissionsAndGivesNewFilesThoseOfTheUmask) {
  for (unsigned bits : {0600u, 0644u, 0755u, 0222u}) {
    const std::string name = file("old", "old");
    ASSERT_EQ(chmod(name.c_str(), bits), 0);
    write(name, "new");
    EXPECT_EQ(mode(name), bits);
    fs::permissions(name, fs::perms::owner_all);
    EXPECT_EQ(contents(name), "new");
  }
  for (mode_t mask : {022, 077}) {
    const mode_t before = umask(mask);
    write(folder / std::to_string(mask), "new");
    umask(before);
    EXPECT_EQ(mode(folder / std::to_string(mask)), 0666u & ~mask);
  }
}

TEST_F(Output, ReplacesWhatALinkPointsTo) {
  fs::create_directory(folder / "d");
  const std::string name = file("d/f", "old");
  fs::create_symlink("d/f", folder / "one");
  fs::create_symlink("one", folder / "two");
  fs::create_symlink("d/none", folder / "to_none");
  fs::create_symlink("round", folder / "round");
  write(folder / "two", "new");
  EXPECT_EQ(contents(name), "new");
  write(folder / "to_none", "made");
  EXPECT_EQ(contents(folder / "d/none"), "made");
  for (const char* link : {"one", "two", "to_none"})
    EXPECT_TRUE(fs::is_symlink(folder / link)) << link;
  EXPECT_NE(error(folder / "round"), "");
  EXPECT_EQ(CME212::output_target(folder / "two"),
            CME212::output_target(folder / "./d/../one"));
  EXPECT_EQ(CME212::output_target(folder / "to_none"),
            CME212::output_target(folder / "d/none"));
}

TEST_F(Output, LeavesOtherHardLinksTheOldContent) {
  const std::string name = file("f", "old");
  fs::create_hard_link(name, folder / "same");
  write(name, "new");
  EXPECT_EQ(contents(name), "new");
  EXPECT_EQ(contents(folder / "same"), "old");
}

TEST_F(Output, RefusesWhatCantBeWritten) {
  const std::string read_only = file("read_only", "kept");
  chmod(read_only.c_str(), 0444);
  auto why = [](const std::string& name, const char* reason) {
    return name + ": can't be written (" + reason + ")";
  };
  EXPECT_EQ(error(""), "an output file has no name");
  EXPECT_EQ(error(folder / ""), why(folder / "", "a directory"));
  EXPECT_EQ(error(folder.path()), why(folder.path(), "a directory"));
  EXPECT_EQ(error(read_only), why(read_only, "Permission denied"));
  EXPECT_EQ(error(folder / "no/f"),
            why(folder / "no/f", "No such file or directory"));
  EXPECT_EQ(error(read_only + "/f"), why(read_only + "/f", "Not a directory"));
  const std::string longest(255, 'x'), too_long(256, 'x');
  EXPECT_EQ(error(folder / too_long),
            why(folder / too_long, "File name too long"));
  write(folder / longest, "new");
  EXPECT_EQ(contents(folder / longest), "new");
  EXPECT_EQ(contents(read_only), "kept");
  // The shell's: ./program --csv f > f
  const std::string own = file("own", "");
  const int before = dup(STDOUT_FILENO);
  ASSERT_NE(std::freopen(own.c_str(), "w", stdout), nullptr);
  const std::string said = error(own);
  dup2(before, STDOUT_FILENO);
  close(before);
  EXPECT_EQ(said, why(own, "the standard output goes there"));
}

TEST_F(Output, SaysWhenTheDiskIsFull) {
  OutputFile full("/dev/full");
  full.stream() << "text";
  EXPECT_EQ(error_of([&] { full.commit(); }),
            "/dev/full: can't be written (No space left on device)");
  const std::string name = file("f", "old");
  CME212::Child child("a writer", [&] {  // no file may have more than 10 kB
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {10000, 10000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string said =
        error_of([&] { write(name, std::string(20000, 'x')); });
    _exit(said.find(name + ": can't be written (") == 0 ? 0 : 1);
  });
  EXPECT_EQ(child.wait(), 0);
  EXPECT_EQ(contents(name), "old");
  EXPECT_EQ(files(), Names{"f"});
}

TEST_F(Output, GivesOutACopyOfWhatIsThereSoFar) {
  const std::string name = folder / "f";
  OutputFile out(name);
  out.commit_copy();
  EXPECT_FALSE(fs::exists(name));
  out.stream() << "one\n";
  out.commit_copy();
  EXPECT_EQ(contents(name), "one\n");
  out.stream() << "two\n" << std::flush;
  EXPECT_EQ(contents(name), "one\n");
  out.commit();
  EXPECT_EQ(contents(name), "one\ntwo\n");
  EXPECT_EQ(files(), Names{"f"});
}

}  // namespace
