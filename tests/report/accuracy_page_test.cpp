// The page of a study: safe whatever a file is called, and drawn by a real browser where there is one.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "odds/report/accuracy/report.hpp"
#include "odds/report/run_report.hpp"
#include "support/temporary_folder.hpp"

namespace odds::report {
namespace {

const std::string hostile = "</script></title><script>document.documentElement.dataset.evil=1</script>";

/// 120 poses under two times, two thresholds, work units and none, right and wrong in turns.
Study made_study(const std::string& mesh) {
  Study study;
  study.settings.mesh_a = study.settings.mesh_b = mesh;
  study.settings.size_m = 1.0;
  study.settings.poses_per_band = 10;
  study.settings.bounding_volume = "wide";
  study.settings.estimator = "kinematic";
  study.version = "0";
  study.machine_fit = false;
  study.machine_note = hostile;
  study.settings.trials = {{Trial::Kind::time, 5, 1.0},
                           {Trial::Kind::time, 20, 1.0},
                           {Trial::Kind::time, 5, 0.9},
                           {Trial::Kind::work, 64, 1.0},
                           {Trial::Kind::exact, 0, 1.0}};
  study.samples.resize(study.settings.trials.size());
  for (std::uint64_t i = 0; i < study.settings.pose_count(); ++i) {
    PoseTruth truth;
    truth.pose.index = i;
    truth.pose.band = static_cast<std::uint32_t>(i % 12);
    truth.hit = truth.pose.band >= 6;
    study.poses.push_back(truth);
    for (std::size_t t = 0; t < study.samples.size(); ++t) {
      Sample sample;
      const bool proved = t == 4 || (i + t) % 3 == 0;
      sample.basis = proved ? query::Basis::proved : query::Basis::budget;
      sample.probability = proved ? (truth.hit ? 1.0 : 0.0) : static_cast<double>(i) / 120.0;
      sample.verdict = sample.probability >= 0.5 ? query::Verdict::hit : query::Verdict::clear;
      sample.wall_us = 1.0 + static_cast<double>(i % 7);
      if (truth.hit) sample.contact = ContactError{0.01, 3.0, 0.002};
      study.samples[t].push_back(sample);
    }
  }
  return study;
}

TEST(AccuracyPage, NothingFromOutsideBecomesMarkup) {
  const testing::TemporaryFolder folder;
  const Study study = made_study(hostile);
  const auto files = write_accuracy_report(folder.path(), study, accuracy_rows(study));
  ASSERT_TRUE(files.ok()) << files.error().message();
  const std::string page = testing::contents_of(files.value().page.string());
  EXPECT_EQ(page.find("<script>document"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;document"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos) << "nothing is fetched";
  EXPECT_EQ(files.value().worst.size(), most_worst_poses);
}

TEST(AccuracyPage, TheSentenceAtTheTopSaysWhatStoppedItsQueries) {
  Study study = made_study("mesh.obj");
  EXPECT_EQ(headline(study, accuracy_rows(study)).rfind("Within 20 µs, ", 0), 0U);
  study.settings.trials = {{Trial::Kind::time, 5, 0.9}, {Trial::Kind::exact, 0, 1.0}};
  study.samples.resize(2);
  EXPECT_EQ(headline(study, accuracy_rows(study)).rfind("Within 5 µs, or stopped at p ≥ 0.9, ", 0), 0U)
      << headline(study, accuracy_rows(study));
}

TEST(AccuracyPage, WhatIsWrittenIsReadBack) {
  const testing::TemporaryFolder folder;
  const Study study = made_study("a,b'c.obj");
  const auto rows = accuracy_rows(study);
  ASSERT_TRUE(write_accuracy_report(folder.path(), study, rows).ok());
  const auto read = read_study(folder.path());
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_TRUE(read.value().settings == study.settings);
  const auto again = accuracy_rows(read.value());
  ASSERT_EQ(again.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(again[i].wrong(), rows[i].wrong());
    EXPECT_EQ(again[i].unproved.brier, rows[i].unproved.brier) << "bit for bit";
    EXPECT_EQ(again[i].contact.p90.normal_deg, rows[i].contact.p90.normal_deg);
    EXPECT_EQ(again[i].wall_us.p99, rows[i].wall_us.p99);
  }
}

TEST(AccuracyPage, SaysHowThePosesOfItsProcedureWereMade) {
  Study study = made_study("a.obj");
  for (const auto& [procedure, says] :
       {std::pair{Procedure::distance, "B comes towards A with a random rotation"},
        {Procedure::tumbling, "B is turned about z at random and comes along x"},
        {Procedure::nested, "B stands inside A, both centres in one place, turned by up to 0.2 degrees"}}) {
    study.settings.procedure = procedure;
    const testing::TemporaryFolder folder;
    study.poses.clear();
    study.samples.assign(study.settings.trials.size(), {});
    const auto files = write_accuracy_report(folder.path(), study, accuracy_rows(study));
    ASSERT_TRUE(files.ok()) << files.error().message();
    EXPECT_NE(testing::contents_of(files.value().page.string()).find(says), std::string::npos) << name(procedure);
  }
}

TEST(AccuracyPage, TheReplayCommandQuotesNamesForTheShell) {
  StudySettings settings;
  settings.mesh_a = "it's a mesh.obj";
  settings.mesh_b = "plain.obj";
  settings.bounding_volume = "obb";
  settings.estimator = "cells";
  const std::string command = replay_command(settings, {Trial::Kind::work, 64, 0.9}, "worst/01.csv");
  EXPECT_NE(command.find("'it'\\''s a mesh.obj' plain.obj"), std::string::npos) << command;
  EXPECT_NE(command.find("--work 64 --p-min 0.9 --k-min 10"), std::string::npos) << command;
  settings.mesh_b = "-x.obj";
  const std::string dashed = replay_command(settings, {Trial::Kind::work, 64, 1.0}, "-out/worst/01.csv");
  EXPECT_NE(dashed.find(" ./-x.obj --poses ./-out/worst/01.csv "), std::string::npos) << dashed << ": no options";
}

TEST(AccuracyPage, ABrowserDrawsAllChartsWithoutAnError) {
  if (!pages_have_charts()) GTEST_SKIP() << "built without a chart library";
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
  const testing::TemporaryFolder folder;
  const Study study = made_study(hostile);
  const auto files = write_accuracy_report(folder.path(), study, accuracy_rows(study));
  ASSERT_TRUE(files.ok());
  const std::string command =
      "timeout 60 chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync --user-data-dir='" +
      (folder / "profile") + "' --window-size=1400,3000 --virtual-time-budget=4000 --dump-dom 'file://" +
      files.value().page.string() + "' >'" + (folder / "dom.html") + "' 2>/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string dom = testing::contents_of(folder / "dom.html");
  const std::size_t begin = dom.find("<html");
  ASSERT_NE(begin, std::string::npos);
  const std::string root = dom.substr(begin, dom.find('>', begin) - begin);
  EXPECT_EQ(root.find("data-error"), std::string::npos) << root;
  EXPECT_EQ(root.find("data-evil"), std::string::npos) << root;
  EXPECT_NE(root.find("data-charts=\"11\""), std::string::npos) << root;
}

}  // namespace
}  // namespace odds::report
