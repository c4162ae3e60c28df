// A reader that crashes, hangs, lies or dies must never take its caller along. The readers here are shell
// scripts.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "../../cad_import/cad_import.h"
#include "../../cad_import/model_stream.h"
#include "../../cad_import/reader_protocol.h"
#include "files.h"

namespace dupin {
namespace {

using test::sample;
using test::scratch;

std::string script(const std::string& name, const std::string& body) {
  const std::string path = test::write_file(name, "#!/bin/sh\n" + body + "\n");
  ::chmod(path.c_str(), 0755);
  return path;
}

Status run(const std::string& reader, double seconds = 20) {
  ImportOptions options;
  options.reader = reader;
  options.time_limit_seconds = seconds;
  return import_cad(sample("bracket.step"), options).status();
}

void expect_one_line(const Status& status, StatusCode code, const std::string& part) {
  EXPECT_EQ(status.code, code) << status.message;
  EXPECT_NE(status.message.find(part), std::string::npos) << status.message;
  EXPECT_EQ(status.message.find('\n'), std::string::npos) << status.message;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string frame(FrameKind kind, const std::string& payload) {
  const FrameHeader header{kFrameMagic, kind, payload.size()};
  return std::string(reinterpret_cast<const char*>(&header), sizeof header) + payload;
}

std::string answering(const std::string& name, const std::string& bytes, const std::string& then = "") {
  const std::string file = test::write_file(name + ".bytes", bytes);
  return script(name, "cat '" + file + "' >&3\n" + then);
}

TEST(ReaderProcess, ACrashIsNamed) {
  expect_one_line(run(script("segv", "kill -SEGV $$")), StatusCode::unreadable, "crashed (SIGSEGV)");
  expect_one_line(run(script("abrt", "kill -ABRT $$")), StatusCode::unreadable, "crashed (SIGABRT)");
}

TEST(ReaderProcess, ACrashSaysInWhichStage) {
  const double half = 0.5;
  const std::string stage(reinterpret_cast<const char*>(&half), sizeof half);
  expect_one_line(run(answering("staged", frame(FrameKind::stage, stage + "reading"), "kill -SEGV $$")),
                  StatusCode::unreadable, "(reading)");
}

TEST(ReaderProcess, AHangEndsAtTheTimeLimit) {
  Status status;
  const double seconds = seconds_of([&] { status = run(script("hang", "sleep 100 & sleep 100"), 0.3); });
  expect_one_line(status, StatusCode::limit, "time limit");
  EXPECT_LT(seconds, 5);
}

TEST(ReaderProcess, WhatAHangingReaderStartedIsGoneToo) {
  const std::string pid_file = scratch() + "/grandchild";
  run(script("brood", "sleep 100 & echo $! > '" + pid_file + "'; wait"), 0.5);
  const pid_t grandchild = static_cast<pid_t>(std::stol(test::read_file(pid_file)));
  bool gone = false;
  for (int i = 0; i < 100 && !gone; ++i) {
    std::ifstream state("/proc/" + std::to_string(grandchild) + "/stat");
    std::string pid, name, letter;
    gone = !(state >> pid >> name >> letter) || letter == "Z";
    if (!gone) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(gone);
}

TEST(ReaderProcess, AnEndWithoutAnAnswerIsReported) {
  expect_one_line(run(script("silent", "exit 0")), StatusCode::unreadable, "without an answer");
  expect_one_line(run(script("failing", "echo no luck >&2; exit 7")), StatusCode::unreadable, "exit code 7");
  expect_one_line(run(script("closing", "exec 3>&-; sleep 100")), StatusCode::unreadable, "hung");
}

TEST(ReaderProcess, GarbageIsRefused) {
  expect_one_line(run(script("noise", "head -c 100000 /dev/urandom >&3")), StatusCode::unreadable, "garbage");
  expect_one_line(run(answering("kind", frame(static_cast<FrameKind>(9), ""))), StatusCode::unreadable,
                  "garbage");
  std::string huge = frame(FrameKind::stage, "");
  huge[8 + 5] = '\x7f';  // a stage of 2^46 bytes
  expect_one_line(run(answering("huge", huge)), StatusCode::unreadable, "garbage");
}

TEST(ReaderProcess, ADamagedModelIsRefused) {
  std::string stream = write_model(Model{});
  expect_one_line(run(answering("cut", frame(FrameKind::model, stream).substr(0, 40))),
                  StatusCode::unreadable, "without an answer");
  stream.back() = static_cast<char>(stream.back() ^ 1);
  expect_one_line(run(answering("flip", frame(FrameKind::model, stream))), StatusCode::unreadable,
                  "checksum");
}

TEST(ReaderProcess, AFailureKeepsItsKindAndBecomesOneLine) {
  const auto failing = [](StatusCode code) {
    const auto number = static_cast<std::uint32_t>(code);
    return frame(FrameKind::failure,
                 std::string(reinterpret_cast<const char*>(&number), 4) + "first\nsecond\x01line");
  };
  expect_one_line(run(answering("limit", failing(StatusCode::limit))), StatusCode::limit, "second line");
  expect_one_line(run(answering("other", failing(static_cast<StatusCode>(77)))), StatusCode::unreadable,
                  "second line");
}

TEST(ReaderProcess, AMissingReaderIsReported) {
  expect_one_line(run(scratch() + "/no-such-reader"), StatusCode::unreadable, "no-such-reader");
  ::setenv("DUPIN_READER", "/no/such/reader", 1);
  expect_one_line(run(""), StatusCode::unreadable, "/no/such/reader");
  ::unsetenv("DUPIN_READER");
}

TEST(ReaderProcess, TheCallerCanStopIt) {
  ImportOptions options;
  options.reader = script("patient", "sleep 100");
  int calls = 0;
  options.progress = [&](std::string_view, double) { return ++calls < 3; };
  const double seconds = seconds_of(
      [&] { EXPECT_EQ(import_cad(sample("bracket.step"), options).status().code, StatusCode::cancelled); });
  EXPECT_LT(seconds, 5);
}

TEST(ReaderProcess, StagesArriveInOrder) {
  ImportOptions options;
  std::vector<std::string> stages;
  options.progress = [&](std::string_view stage, double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    return true;
  };
  ASSERT_TRUE(import_cad(sample("bracket.step"), options).ok());
  const auto at = [&](const char* stage) { return std::find(stages.begin(), stages.end(), stage); };
  EXPECT_NE(at("reading"), stages.end());
  EXPECT_LT(at("reading"), at("converting"));
}

TEST(ReaderProcess, TooLittleMemoryIsALimit) {
  ImportOptions options;
  options.memory_limit_bytes = 420u << 20;  // enough to start with
  ASSERT_TRUE(import_cad(sample("bracket.step"), options).ok());
  options.memory_limit_bytes = 30u << 20;
  const Status status = import_cad(sample("freeform.step"), options).status();
  EXPECT_EQ(status.code, StatusCode::limit) << status.message;
}

TEST(ReaderProcess, WrongOptionsAreTheCallersFault) {
  ImportOptions options;
  options.assumed_unit = "parsec";
  EXPECT_EQ(import_cad(sample("bracket.step"), options).status().code, StatusCode::invalid_argument);
  options = {};
  options.mesh_deflection = -1;
  EXPECT_EQ(import_cad(sample("bracket.step"), options).status().code, StatusCode::invalid_argument);
  options = {};
  options.time_limit_seconds = -1;
  EXPECT_EQ(import_cad(sample("bracket.step"), options).status().code, StatusCode::invalid_argument);
}

// The first process whose parent is `parent`; 0 if there is none.
pid_t child_of(pid_t parent) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    std::ifstream stat(entry.path() / "stat");
    std::string pid, name, state;
    pid_t of = 0;
    if (stat >> pid >> name >> state >> of && of == parent) return static_cast<pid_t>(std::stol(pid));
  }
  return 0;
}

TEST(ReaderProcess, TheReaderDiesWithItsCaller) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t caller = ::fork();
  if (caller == 0) {
    ImportOptions options;
    options.progress = [&](std::string_view stage, double) {
      if (stage != "reading") return true;
      const pid_t reader = child_of(::getpid());
      ::kill(reader, SIGSTOP);  // it cannot finish before its caller is gone
      const bool told = ::write(ends[1], &reader, sizeof reader) == sizeof reader;
      ::kill(::getpid(), told ? SIGKILL : SIGTERM);
      return true;
    };
    (void)import_cad(sample("freeform.step"), options);
    ::_exit(1);
  }
  pid_t reader = 0;
  ASSERT_EQ(::read(ends[0], &reader, sizeof reader), static_cast<ssize_t>(sizeof reader));
  int status = 0;
  ::waitpid(caller, &status, 0);
  ASSERT_GT(reader, 0);
  bool gone = false;
  for (int i = 0; i < 200 && !gone; ++i) {
    std::ifstream stat("/proc/" + std::to_string(reader) + "/stat");
    std::string pid, name, state;
    gone = !(stat >> pid >> name >> state) || state == "Z";
    if (!gone) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(gone) << "process " << reader << " outlived its caller";
  ::close(ends[0]), ::close(ends[1]);
}

}  // namespace
}  // namespace dupin
