// What ./cloth writes, and what it leaves alone: names, links, several outputs,
// full disks; and a run that a signal ends.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "lab/scenes/MeshFile.hpp"
#include "tests/ClothProgram.hpp"

namespace {

const std::string small = "--sheet 'nodes 4 4' --t-end 0.02 --headless ";

TEST_F(ClothProgram, RefusesTwoOutputsInOneFile) {
  fs::create_directory(dir / "d");
  fs::create_symlink("d", dir / "link");
  const std::string one = path("d/x");
  auto clash = [&](const std::string& a, const std::string& b) {
    EXPECT_TRUE(has(refusal(small + a + ' ' + b),
                    " also writes, expected another file\n"));
    EXPECT_TRUE(fs::is_empty(dir / "d")) << a << b;
  };
  clash("--csv " + one, "--out " + one);
  clash("--csv " + one, "--out " + path("d/./../d/x"));
  clash("--csv " + one, "--out " + path("link/x"));
  clash("--auto --write-config " + one, "--csv " + one);
  EXPECT_EQ(run(small + "--out " + one + " --csv " + one).err,
            "cloth: --out is " + one +
                ", which --csv also writes, expected another file\n");
  EXPECT_EQ(run(small + "--csv /dev/null --out /dev/null").status, 0);
  EXPECT_EQ(run(small + "--csv " + path("d/a") + " --out " + one).status, 0);
}

TEST_F(ClothProgram, SaysWhichLineNamesAnOutputThatCantBe) {
  for (const char* option : {"csv", "out", "checkpoint", "vtp"}) {
    const std::string scene =
        file("a.toml",
             "sheet = 'nodes 4 4'\n" + std::string(option) + " = 'no/x'\n");
    EXPECT_TRUE(begins(refusal("--headless --config " + scene),
                       scene + ":2: " + path("no/x") + ": can't be "));
  }
}

TEST_F(ClothProgram, LeavesTheFilesItReadsAlone) {
  const std::string nodes = file("a.nodes", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n");
  const std::string tets = file("a.tets", "0 1 2 3\n");
  const std::string config =
      file("a.toml", "nodes = 'a.nodes'\ntets = 'a.tets'\nt-end = 0.02\n");
  fs::create_symlink("a.toml", dir / "link");
  const std::string scene = "--headless --config " + config;
  auto refuses = [&](const std::string& option, const std::string& input,
                     const std::string& reader) {
    const std::string before = contents(input);
    EXPECT_EQ(refusal(scene + " --" + option + ' ' + input),
              "cloth: --" + option + " is " + input + ", which --" + reader +
                  " reads, expected another file\n");
    EXPECT_EQ(contents(input), before);
  };
  refuses("csv", nodes, "nodes");
  refuses("csv", tets, "tets");
  refuses("csv", config, "config");
  refuses("out", path("link"), "config");
  refuses("checkpoint", nodes, "nodes");
  EXPECT_EQ(run(scene + " --out " + nodes).status, 0);  // goes on in place
}

TEST_F(ClothProgram, RefusesAnEmptyNameOfAFile) {
  for (const char* option : {"csv", "out", "screenshot", "record", "config",
                             "write-config", "nodes", "tets"})
    for (const char* scene : {"--sheet 'nodes 4 4'", "data/grid0.nodes"})
      EXPECT_EQ(refusal(std::string("--") + option + " '' " + scene),
                std::string("cloth: --") + option +
                    ": is empty, expected a file name\n");
}

TEST_F(ClothProgram, TakesNoOptionForTheNameOfAFile) {
  for (const char* option : {"csv", "out", "vtp", "checkpoint", "write-config"})
    for (const char* end : {" --quiet", "= --quiet"}) {
      EXPECT_EQ(refusal(small + "--" + option + end),
                std::string("cloth: --") + option +
                    ": is --quiet, expected a file name, such as ./--quiet\n");
      EXPECT_FALSE(fs::exists("--quiet"));
    }
}

TEST_F(ClothProgram, SaysWhenTheStandardOutputIsFull) {
  const std::string cloth = CME212::program("cloth", "build/");
  for (const std::string& options :
       {small, small + "--dump-config", std::string("--list-methods"),
        std::string("--help"), std::string("--version"),
        small + "--advise --tolerance 1"}) {
    // The last redirection of a file wins.
    Result r = folder.run("sh -c \"" + cloth + ' ' + options +
                          " >/dev/full; echo status \\$?\"");
    EXPECT_EQ(r.out, "status 2\n") << options;
    EXPECT_TRUE(has(r.err, "cloth: the standard output can't be written ("))
        << options;
  }
  EXPECT_EQ(folder
                .run("sh -c \"" + cloth + ' ' + small +
                     " --quiet >&-; echo status \\$? >&2\"")
                .err,
            "status 0\n");
}

// A file that is opened must not get what is printed.
TEST_F(ClothProgram, PrintsIntoNoFileIfItsDescriptorsAreClosed) {
  const std::string outputs = small + "--checkpoint " + path("c") + " --csv " +
                              path("e.csv") + " --out " + path("end.nodes");
  const auto all = [this] {
    return contents(dir / "e.csv") + contents(dir / "end.nodes") +
           contents(dir / "end.tets") + contents(dir / "c");
  };
  EXPECT_EQ(run(outputs).status, 0);
  const std::string right = all();
  for (const auto& [closed, status] :
       {std::pair(">&-", 2), std::pair("<&- >&-", 2),
        std::pair("<&- >&- 2>&-", 2), std::pair("<&- 2>&-", 0)}) {
    for (const std::string& name : files()) fs::remove(dir / name);
    Result r = folder.run("sh -c \"" + CME212::program("cloth", "build/") +
                          ' ' + outputs + ' ' + closed + "; exit \\$?\"");
    EXPECT_EQ(r.status, status) << closed << r.err;
    EXPECT_TRUE(all() == right) << closed;
    EXPECT_EQ(files().size(), 4u);
  }
}

// The renderer would end by SIGSEGV.
TEST_F(ClothProgram, SaysThatThereIsNoMemoryToDraw) {
  const std::string film = path("v.mp4");
  Result r = folder.run("sh -c \"ulimit -v 400000; exec timeout 60 " +
                        CME212::program("cloth", "build/") + ' ' + small +
                        "--record " + film + '"');
  EXPECT_EQ(r.status, 2);
  EXPECT_EQ(r.err,
            "cloth: out of memory: expected a cloth of fewer nodes, or more "
            "memory\n");
  EXPECT_FALSE(fs::exists(film));
}

TEST_F(ClothProgram, RefusesAFilmOfMoreThanADay) {
  EXPECT_EQ(refusal("--sheet 'nodes 4 4' --t-end 1e300 --dt auto --quiet "
                    "--record " +
                    path("v.mp4")),
            "cloth: --t-end is 1e+300, expected at most 86400 s (a day) for a "
            "film\n");
}

// ------------------------------------------------------- Ended by a signal

const std::string long_run =
    "--sheet 'nodes 12 12' --pin 'y 0' --t-end 1e5 --headless ";

TEST_F(ClothProgram, KeepsWhatItHasWhenASignalEndsIt) {
  const struct {
    int number;
    const char* name;
  } all[] = {{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}};
  for (const auto& [number, name] : all)
    for (const char* quiet : {"", "--quiet "}) {
      fs::remove(dir / "c");  // it is there again after a step
      Result r =
          interrupt(long_run + quiet + "--every 5 --csv " + path("e.csv") +
                        " --out " + path("end.nodes") +
                        " --every-seconds 1000 --checkpoint " + path("c"),
                    {number}, [this] { return fs::exists(dir / "c"); });
      EXPECT_EQ(r.status, 128 + number) << r.err;
      const auto table = rows(dir / "e.csv");
      ASSERT_GE(table.size(), 1u);
      for (std::size_t k = 0; k < table.size(); ++k) {
        EXPECT_EQ(table[k].size(), 14u);
        EXPECT_NEAR(table[k][0], 0.005 * double(k), 1e-9);
      }
      EXPECT_EQ(
          lab::parse_nodes(contents(dir / "end.nodes"), "end").points.size(),
          144u);
      EXPECT_TRUE(
          has(r.err, std::string("cloth: ") + name + " ended the run at t = "));
      EXPECT_TRUE(has(r.err, " s of 100000 s; kept: checkpoint " + path("c") +
                                 ", " + path("e.csv") + " (" +
                                 CME212::count_of(table.size(), "row") + "), " +
                                 path("end.nodes") + '\n'));
      EXPECT_EQ(r.out.find(" steps to t = ") == std::string::npos, *quiet != 0);
      EXPECT_FALSE(has(r.out, "com:"));  // no answer
      EXPECT_EQ(files(), (std::vector<std::string>{"c", "e.csv", "end.nodes",
                                                   "end.tets"}));
    }
  EXPECT_TRUE(has(interrupt(long_run, {SIGTERM}).err,
                  "kept: nothing, as no output was requested\n"));
}

// It waits: what it writes goes into a pipe that is full, and nobody reads.
TEST_F(ClothProgram, EndsAtOnceByTheSecondSignal) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (int second : {SIGINT, SIGTERM}) {
    const int pipe = open(path("pipe").c_str(), O_RDWR | O_CLOEXEC);
    const int size = fcntl(pipe, F_SETPIPE_SZ, 4096);
    Result r = interrupt(long_run + "--every 1 --csv " + path("pipe") +
                             " --out " + path("end.nodes"),
                         {SIGINT, second}, [&] {
                           int written = 0;
                           return ioctl(pipe, FIONREAD, &written) == 0 &&
                                  written == size;
                         });
    close(pipe);
    EXPECT_EQ(r.status, 1000 + second) << r.err;
    EXPECT_FALSE(fs::exists(path("end.nodes")));
    for (const std::string& name : files())
      EXPECT_TRUE(name == "pipe" || name.ends_with(".part")) << name;
  }
}

TEST_F(ClothProgram, EndsByTheFirstSignalWhileNobodyReadsItsPipe) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  CME212::Child child = start(long_run + "--csv " + path("pipe"), "");
  child.until([&] { return catches(child, SIGTERM) && waits(child); });
  child.signal(SIGTERM);
  const Result r = result_of(child.wait());
  EXPECT_EQ(r.status, 128 + SIGTERM);
  EXPECT_NE(r.err.find("(no program reads it)\n"), r.err.npos) << r.err;
}

TEST_F(ClothProgram, LeavesIgnoredSignalsIgnored) {
  Result r = interrupt(
      long_run + "--checkpoint " + path("c"), {SIGHUP, SIGTERM},
      [this] { return fs::exists(dir / "c"); }, "trap '' HUP; ");
  EXPECT_EQ(r.status, 128 + SIGTERM);
  EXPECT_FALSE(has(r.err, "SIGHUP"));
}

TEST_F(ClothProgram, ReadsAPipe) {
  const std::string pipe = path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string cloth = CME212::program("cloth", "build/");
  const std::string rest = " data/grid0.tets --t-end 0.01 --headless --out ";
  EXPECT_EQ(run("data/grid0.nodes" + rest + path("a.nodes")).status, 0);
  Result r = folder.run("sh -c \"timeout 60 cat data/grid0.nodes >" + pipe +
                        " & timeout 60 " + cloth + ' ' + pipe + rest +
                        path("b.nodes") + '"');
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(contents(dir / "a.nodes"), contents(dir / "b.nodes"));
}

TEST_F(ClothProgram, EndsTheAdviceByASignal) {
  Result r = interrupt(
      "--sheet 'u 1 0 0 v 0 0 -1' --pin 'z 0' --modulus 100 --density 1 "
      "--t-end "
      "0.2 --tolerance 1e-5 --advise --advise-work 1e13 --write-config " +
          path("a.toml"),
      {SIGINT}, [this] { return !contents(dir / "err").empty(); });
  EXPECT_EQ(r.status, 130);
  EXPECT_TRUE(
      r.err.ends_with("\ncloth: SIGINT ended the advice; nothing was kept\n"))
      << r.err;
  EXPECT_EQ(files(), std::vector<std::string>{});
}

}  // namespace
