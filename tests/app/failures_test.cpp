// What the command does when it cannot do what it was asked: the documented exit code, one clear line,
// nothing written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <random>

#include "command.h"

namespace dupin::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr double kSeconds = 20;  // "within seconds", on a busy machine

/// Failed with that code, and said why in one line.
void expect_failure(const Outcome& outcome, int code, const std::string& says = "") {
  EXPECT_EQ(outcome.exit_code, code) << outcome.err;
  EXPECT_EQ(outcome.error_lines(), 1) << outcome.err;
  EXPECT_THAT(outcome.err, StartsWith("dupin: "));
  EXPECT_THAT(outcome.err, HasSubstr(says));
  EXPECT_LT(outcome.seconds, kSeconds);
}

std::string noise(std::size_t bytes) {
  std::mt19937 random(20261);
  std::string text(bytes, 0);
  for (char& c : text) c = static_cast<char>(random());
  return text;
}

std::string dangling_step() {
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
         "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n#1=ADVANCED_FACE('',(#100),#101,.T.);\n"
         "#2=CLOSED_SHELL('',(#1,#102));\n#3=MANIFOLD_SOLID_BREP('',#2);\n"
         "#4=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#103,#3),#104);\nENDSEC;\nEND-ISO-10303-21;\n";
}

/// A file that cannot be read, by name: `render` and `info` both refuse it and leave nothing behind.
class BadInput : public testing::TestWithParam<std::string> {
 protected:
  std::string make(const Folder& folder) const {
    const std::string kind = GetParam();
    const std::string good = read_file(sample("bracket.step"));
    if (kind == "empty") return folder.write("bad.step", "");
    if (kind == "noise") return folder.write("bad.step", noise(100'000));
    if (kind == "truncated") return folder.write("bad.step", good.substr(0, good.size() / 3));
    if (kind == "header_only") return folder.write("bad.step", good.substr(0, good.find("DATA;")));
    if (kind == "text_as_brep") return folder.write("bad.brep", "Once upon a time there was a cube.\n");
    if (kind == "dangling") return folder.write("bad.step", dangling_step());
    if (kind == "folder") return folder.path("");
    return folder.path("missing.step");
  }
};

TEST_P(BadInput, IsRefusedAndNothingIsWritten) {
  const Folder input, output;
  const std::string file = make(input);
  expect_failure(run_dupin({"info", file}), 3);
  expect_failure(run_dupin({"render", file, "-o", output.path("a.png"), "--stats", output.path("a.json")}),
                 3);
  EXPECT_THAT(output.names(), IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(Failures, BadInput,
                         testing::Values("empty", "noise", "truncated", "header_only", "text_as_brep",
                                         "dangling", "folder", "missing"),
                         [](const auto& info) { return info.param; });

TEST(Failures, ContentDecidesWhatAFileIsNotItsName) {
  const Folder folder;
  const std::string file = folder.write("bracket.igs", read_file(sample("bracket.step")));
  const Outcome outcome = run_dupin({"info", file, "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\"STEP\""));
}

struct WrongUsage {
  const char* name;
  std::vector<std::string> arguments;
  const char* says;
};
// What CTest calls the case.
void PrintTo(const WrongUsage& usage, std::ostream* out) {
  *out << usage.name;
}

class Usage : public testing::TestWithParam<WrongUsage> {};

TEST_P(Usage, ExitCodeIsTwo) {
  const Folder folder;
  std::vector<std::string> arguments = GetParam().arguments;
  for (std::string& argument : arguments)
    if (argument == "OUT")
      argument = folder.path("out.png");
    else if (argument == "OUT.jpg")
      argument = folder.path("out.jpg");
    else if (argument == "MODEL")
      argument = sample("bracket.step");
  expect_failure(run_dupin(arguments), 2, GetParam().says);
  EXPECT_THAT(folder.names(), IsEmpty());
}
INSTANTIATE_TEST_SUITE_P(
    Failures, Usage,
    testing::Values(
        WrongUsage{"nothing", {}, "--help"}, WrongUsage{"unknown_command", {"paint", "MODEL"}, "'paint'"},
        WrongUsage{"no_file", {"render", "-o", "OUT"}, "FILE"},
        WrongUsage{"no_output", {"render", "MODEL"}, "--output"},
        WrongUsage{"unknown_option", {"render", "MODEL", "-o", "OUT", "--sparkle"}, "--sparkle"},
        WrongUsage{"output_kind", {"render", "MODEL", "-o", "OUT.jpg"}, ".png or .exr"},
        WrongUsage{"view", {"render", "MODEL", "-o", "OUT", "--view", "inside"}, "inside"},
        WrongUsage{"domains_of_no_domains", {"render", "MODEL", "-o", "OUT", "--shading", "domains"}, "amg"},
        WrongUsage{"level_of_no_domains", {"render", "MODEL", "-o", "OUT", "--amg-level", "3"}, "amg"},
        WrongUsage{"unknown_primitive", {"render", "MODEL", "-o", "OUT", "--primitive", "cubes"}, "cubes"},
        WrongUsage{"eye_of_two_numbers", {"render", "MODEL", "-o", "OUT", "--eye", "1,2"}, "--eye"},
        WrongUsage{"eye_is_target",
                   {"render", "MODEL", "-o", "OUT", "--eye", "1,2,3", "--target", "1,2,3"},
                   "--target"},
        WrongUsage{
            "height_without_parallel", {"render", "MODEL", "-o", "OUT", "--height", "3"}, "--orthographic"},
        WrongUsage{"resolution", {"render", "MODEL", "-o", "OUT", "--resolution", "0,100"}, "--resolution"},
        WrongUsage{"tolerance", {"render", "MODEL", "-o", "OUT", "--tolerance", "-1"}, "--tolerance"},
        WrongUsage{"color", {"render", "MODEL", "-o", "OUT", "--color", "octarine"}, "octarine"},
        WrongUsage{"aov_of_png", {"render", "MODEL", "-o", "OUT", "--aov", "depth"}, "--aov"},
        WrongUsage{"units", {"info", "MODEL", "--units", "furlong"}, "furlong"},
        WrongUsage{"threads", {"info", "MODEL", "--threads", "-3"}, "--threads"},
        WrongUsage{"memory", {"info", "MODEL", "--memory-limit", "lots"}, "lots"},
        WrongUsage{"quiet_and_verbose", {"info", "MODEL", "--quiet", "--verbose"}, "--quiet"}),
    [](const auto& info) { return info.param.name; });

TEST(Failures, UnwritableOutputIsSaidBeforeAnyWork) {
  const Folder folder;
  expect_failure(run_dupin({"render", sample("bracket.step"), "-o", folder.path("missing/out.png")}), 3,
                 "cannot write");
  expect_failure(run_dupin({"render", sample("bracket.step"), "-o", "/proc/out.png"}), 3, "cannot write");
  mkdir(folder.path("folder.png").c_str(), 0700);
  expect_failure(run_dupin({"render", sample("bracket.step"), "-o", folder.path("folder.png")}), 3,
                 "cannot write");
  // The picture could be written, its statistics cannot: neither is.
  expect_failure(run_dupin({"render", sample("bracket.step"), "-o", folder.path("a.png"), "--stats",
                            folder.path("missing/a.json")}),
                 3, "cannot write");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"folder.png"});
}

TEST(Failures, AFailureKeepsTheOldOutput) {
  const Folder folder;
  const std::string old = folder.write("a.png", "old"), bad = folder.write("bad.step", "nothing");
  expect_failure(run_dupin({"render", bad, "-o", old}), 3);
  EXPECT_EQ(read_file(old), "old");
}

TEST(Failures, ATimeLimitEndsTheCommand) {
  const Folder folder;
  const Outcome outcome =
      run_dupin({"render", sample("bracket.step"), "-o", folder.path("a.png"), "--time-limit", "0.001"});
  expect_failure(outcome, 5, "time limit");
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(Failures, AMemoryLimitEndsTheCommand) {
  const Folder folder;
  const Outcome outcome =
      run_dupin({"render", sample("bracket.step"), "-o", folder.path("a.png"), "--memory-limit", "1M"});
  expect_failure(outcome, 5, "memory limit");
  EXPECT_THAT(folder.names(), IsEmpty());
}

/// A reader of the test's own, in place of the real one.
class BadReader : public testing::Test {
 protected:
  void use(const std::string& script) {
    const std::string reader = folder_.write("reader", "#!/bin/sh\n" + script + "\n");
    chmod(reader.c_str(), 0700);
    setenv("DUPIN_READER", reader.c_str(), 1);
  }
  void TearDown() override { unsetenv("DUPIN_READER"); }
  Outcome render(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"render", sample("bracket.step"), "-o", output_.path("a.png")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_dupin(arguments);
  }
  Folder folder_, output_;
};

TEST_F(BadReader, ThatCrashesIsReported) {
  use("kill -SEGV $$");
  expect_failure(render(), 3, "bracket.step");
  EXPECT_THAT(output_.names(), IsEmpty());
}

TEST_F(BadReader, ThatHangsIsEndedWhenTheTimeIsOver) {
  use("exec sleep 100");
  const Outcome outcome = render({"--time-limit", "1"});
  expect_failure(outcome, 5);
  EXPECT_LT(outcome.seconds, 4);
  EXPECT_THAT(output_.names(), IsEmpty());
}

TEST_F(BadReader, ThatAnswersNonsenseIsReported) {
  use("head -c 100000 /dev/urandom");
  expect_failure(render(), 3);
  EXPECT_THAT(output_.names(), IsEmpty());
}

TEST_F(BadReader, ThatIsNotThereIsReported) {
  setenv("DUPIN_READER", folder_.path("none").c_str(), 1);
  expect_failure(render(), 3, "reader");
}

// Bytes changed anywhere: the kernel behind the reader may crash on any of these, the command may not.
TEST(Failures, DamagedFilesAreDrawnRefusedOrDrawnInPart) {
  const std::string good = read_file(sample("bracket.step"));
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string bad = good;
    for (unsigned i = 0; i < 3 * seed; ++i)
      bad[random() % bad.size()] = static_cast<char>('0' + random() % 10);
    const Folder input, output;
    const Outcome outcome =
        run_dupin({"render", input.write("bad.step", bad), "-o", output.path("a.png"), "--resolution",
                   "64,64", "--time-limit", "20", "--memory-limit", "4G"});
    EXPECT_THAT(outcome.exit_code, testing::AnyOf(0, 3, 4, 5)) << outcome.err;
    EXPECT_EQ(output.names().size(), outcome.exit_code == 0 || outcome.exit_code == 4 ? 1u : 0u);
    EXPECT_LT(outcome.seconds, 22);
  }
}

TEST(Failures, QuietSaysNothingWhenAllIsWell) {
  const Folder folder;
  const Outcome outcome =
      run_dupin({"render", sample("bracket.step"), "-o", folder.path("a.png"), "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, "");
}

}  // namespace
}  // namespace dupin::test
