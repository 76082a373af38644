// Output files: whole or not at all, through links and pipes, whoever else writes there.
#include "mesh/output_file.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <thread>
#include <vector>

#include "support/temporary_folder.hpp"

namespace odds::mesh {
namespace {

using testing::contents_of;
using testing::TemporaryFolder;

std::size_t entries(const TemporaryFolder& folder) {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
  return count;
}

TEST(OutputFiles, AreThereWhenTheyAreCommittedAndNotBefore) {
  const TemporaryFolder folder;
  folder.write("a", "old");
  {
    auto file = OutputFile::open(folder / "a");
    ASSERT_TRUE(file.ok()) << file.error().message();
    OutputStream(file.value()) << "new " << 5 << std::flush;
    EXPECT_EQ(contents_of(folder / "a"), "old");
    EXPECT_FALSE(file.value().commit());
  }
  EXPECT_EQ(contents_of(folder / "a"), "new 5");
  { const auto given_up = OutputFile::open(folder / "a"); }
  EXPECT_EQ(contents_of(folder / "a"), "new 5");
  EXPECT_EQ(entries(folder), 1U);
}

TEST(OutputFiles, HaveThePermissionsOfWhatTheyReplace) {
  const TemporaryFolder folder;
  folder.write("a", "old");
  for (const mode_t mode : {0600U, 0640U, 0755U, 0400U}) {
    ASSERT_EQ(chmod((folder / "a").c_str(), mode), 0);
    EXPECT_FALSE(write_file(folder / "a", "new"));
    struct stat after {};
    ASSERT_EQ(stat((folder / "a").c_str(), &after), 0);
    EXPECT_EQ(after.st_mode & 07777U, mode);
  }
}

TEST(OutputFiles, HaveNamesAsLongAsTheSystemAllows) {
  const TemporaryFolder folder;
  const std::string longest(255, 'n');
  EXPECT_FALSE(write_file(folder / longest, "new"));
  EXPECT_EQ(contents_of(folder / longest), "new");
  const auto refused = OutputFile::open(folder / (longest + "n"));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().remedy, "give it a shorter name");
}

TEST(OutputFiles, GoThroughLinks) {
  const TemporaryFolder folder;
  folder.write("target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  std::filesystem::create_symlink("later", folder / "dangling");
  for (const char* link : {"link", "dangling"}) {
    EXPECT_FALSE(write_file(folder / link, "new"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / link));
  }
  EXPECT_EQ(contents_of(folder / "target"), "new");
  EXPECT_EQ(contents_of(folder / "later"), "new");
  std::filesystem::create_symlink("circle", folder / "circle");
  EXPECT_TRUE(write_file(folder / "circle", "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "circle"));
}

TEST(OutputFiles, APipeIsWrittenToAndStaysAPipe) {
  const TemporaryFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  const int reader = ::open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_FALSE(write_file(path, "through"));
  std::array<char, 32> read{};
  EXPECT_EQ(::read(reader, read.data(), read.size()), 7);
  ::close(reader);
  EXPECT_EQ(std::string(read.data()), "through");
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

// A file behind /dev/stdout was replaced: what stood in a log was lost, and so was what the program went on to say.
TEST(OutputFiles, AnOpenFileOfTheProgramIsWrittenOnAndNotReplaced) {
  const TemporaryFolder folder;
  folder.write("log", "old ");
  const int log = ::open((folder / "log").c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  ASSERT_GE(log, 0);
  const std::string number = std::to_string(log);
  std::filesystem::create_symlink("/dev/fd/" + number, folder / "link");
  for (const std::string& path : {"/dev/fd/" + number, "/proc/self/fd/" + number, folder / "link"}) {
    const auto error = write_file(path, "new ");
    EXPECT_FALSE(error) << error->message();
  }
  EXPECT_EQ(::write(log, "on", 2), 2);
  EXPECT_EQ(contents_of(folder / "log"), "old new new new on");
  EXPECT_EQ(entries(folder), 2U);
  std::filesystem::remove(folder / "log");
  EXPECT_FALSE(write_file("/dev/fd/" + number, "new "));
  EXPECT_EQ(entries(folder), 1U) << "one that has no name any more gets none";
  ::close(log);
  const auto refused = write_file("/dev/fd/" + number, "text");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->file, "/dev/fd/" + number);
  const int reading = ::open((folder / "file").c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_GE(reading, 0);
  EXPECT_TRUE(write_file("/dev/fd/" + std::to_string(reading), "text"));
  ::close(reading);
}

TEST(OutputFiles, OfSeveralWritersOneWinsWhole) {
  const TemporaryFolder folder;
  std::vector<std::thread> writers;
  for (char c = 'a'; c < 'e'; ++c) {
    writers.emplace_back([&folder, c] {
      for (int i = 0; i < 3; ++i) EXPECT_FALSE(write_file(folder / "shared", std::string(100'000, c)));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string text = contents_of(folder / "shared");
  EXPECT_EQ(text.size(), 100'000U);
  EXPECT_EQ(text.find_first_not_of(text[0]), std::string::npos);
  EXPECT_EQ(entries(folder), 1U);
}

TEST(OutputFiles, LeftoversOfADeadProcessAreNoObstacle) {
  const TemporaryFolder folder;
  constexpr std::size_t left = 60;
  for (std::size_t i = 0; i < left; ++i) {
    folder.write("odds-" + std::to_string(getpid()) + "-" + std::to_string(i) + ".part", "left");
  }
  EXPECT_FALSE(write_file(folder / "a", "new"));
  EXPECT_EQ(contents_of(folder / "a"), "new");
  EXPECT_EQ(entries(folder), left + 1);
}

TEST(OutputFiles, WhatCannotBeWrittenIsAnErrorWithItsReason) {
  const TemporaryFolder folder;
  folder.write("file", "x");
  for (const std::string& path : {folder / "missing/x", folder / "file/x", folder.path().string()}) {
    const auto error = write_file(path, "text");
    ASSERT_TRUE(error) << path;
    EXPECT_EQ(error->file, path);
    EXPECT_NE(error->what.find("cannot be written: "), std::string::npos) << error->what;
    EXPECT_FALSE(error->remedy.empty());
  }
  EXPECT_TRUE(write_file("", "text"));
  EXPECT_EQ(entries(folder), 1U);
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const auto full = write_file("/dev/full", std::string(100'000, 'x'));
  ASSERT_TRUE(full);
  EXPECT_NE(full->what.find("No space left"), std::string::npos) << full->what;
}

}  // namespace
}  // namespace odds::mesh
