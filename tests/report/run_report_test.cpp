// The files of a run: figures against the records, text that is safe whatever a scene is called, no reference outside.
#include "odds/report/run_report.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "odds/report/hgrm.hpp"
#include "odds/report/hlog.hpp"
#include "report/made_recording.hpp"
#include "report/run_files.hpp"
#include "report/text.hpp"

namespace odds::report {
namespace {

namespace fs = std::filesystem;
using State = Check::State;

class RunReport : public ::testing::Test {
 protected:
  void SetUp() override { directory_ = fs::temp_directory_path() / ("odds_run_report_" + std::to_string(::getpid())); }
  void TearDown() override { fs::remove_all(directory_); }

  RunFiles write(const MadeRecording& made) const {
    const auto files = write_run_report(directory_, made.info, summarize(made.info, made.ticks), made.ticks);
    EXPECT_TRUE(files.ok()) << files.error().message();
    return files.value();
  }
  static std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path directory_;
};

State state(const RunSummary& summary, const std::string& key) {
  for (const Check& check : summary.checks) {
    if (check.key == key) return check.state;
  }
  ADD_FAILURE() << "no check " << key;
  return State::not_measured;
}

/// A short recording without any trouble.
MadeRecording calm_recording() {
  MadeRecording made = made_recording(1.0);
  for (haptics::TickRecord& tick : made.ticks) {
    tick.woke_ns = tick.planned_ns + 50'000;
    tick.done_ns = tick.planned_ns + 200'000;
    tick.query_gross_us = tick.query_net_us;
    tick.query_stall_us = 0.0;
  }
  return made;
}

TEST(RunSummary, a_calm_run_keeps_every_promise) {
  const MadeRecording made = calm_recording();
  for (const Check& check : summarize(made.info, made.ticks).checks) {
    EXPECT_EQ(check.state, State::met) << check.key << ": " << check.finding;
  }
}

TEST(RunSummary, each_kind_of_trouble_is_found_by_its_own_promise) {
  const auto with = [](auto change) {
    MadeRecording made = calm_recording();
    change(made);
    return summarize(made.info, made.ticks);
  };
  EXPECT_EQ(state(with([](auto& m) { m.ticks[5].done_ns += 2'000'000; }), "deadline"), State::missed);
  EXPECT_EQ(state(with([](auto& m) { m.info.loop.skipped = 1; }), "answered"), State::missed);
  EXPECT_EQ(state(with([](auto& m) { m.ticks[5].allocations = 1; }), "memory"), State::missed);
  EXPECT_EQ(state(with([](auto& m) { m.ticks[5].minor_faults = 1; }), "memory"), State::missed);
  EXPECT_EQ(state(with([](auto& m) { m.ticks[5].voluntary_switches = 1; }), "memory"), State::missed);
  EXPECT_EQ(state(with([](auto& m) { m.ticks[5].force_n[1] = std::numeric_limits<double>::quiet_NaN(); }), "force"),
            State::missed);
  EXPECT_EQ(state(with([](auto& m) { m.ticks[5].safety = haptics::safety_faulted; }), "force"), State::missed);
  EXPECT_EQ(state(with([](auto& m) { m.ticks.pop_back(); }), "recording"), State::missed);
  EXPECT_EQ(state(with([](auto& m) {
                    for (auto& tick : m.ticks) tick.query_net_overshoot_us = 1.5;
                  }),
                  "budget"),
            State::missed);
}

TEST(RunSummary, times_on_a_restless_machine_are_inconclusive_and_counts_are_judged_all_the_same) {
  MadeRecording made = calm_recording();
  made.info.fitness->fit = false;
  made.ticks[5].done_ns += 2'000'000;
  made.ticks[6].allocations = 3;
  RunSummary summary = summarize(made.info, made.ticks);
  EXPECT_EQ(state(summary, "machine"), State::inconclusive);
  EXPECT_EQ(state(summary, "deadline"), State::inconclusive);
  EXPECT_EQ(state(summary, "budget"), State::inconclusive) << "neither passed nor failed";
  EXPECT_EQ(state(summary, "memory"), State::missed);

  made.info.fitness.reset();
  for (auto& tick : made.ticks) tick.query_stall_us = 0.1 * tick.query_gross_us;
  summary = summarize(made.info, made.ticks);
  EXPECT_NEAR(summary.stall_share, 0.1, 1e-9);
  EXPECT_EQ(state(summary, "budget"), State::inconclusive) << "by the stalls that the queries saw themselves";
}

/// A calm run in simulated time: limits are work units, no stalls are measured.
MadeRecording simulated_recording() {
  MadeRecording made = calm_recording();
  made.info.simulated_time = true;
  made.info.fitness.reset();
  made.info.budget_us = std::numeric_limits<double>::infinity();
  made.info.work_units = 2000;
  made.info.frame_work_units = 7000;
  made.info.max_contacts = 8;
  made.info.max_contacts_per_step = 64;
  made.info.carry_motion = 0.001;
  return made;
}

TEST(RunSummary, simulated_time_passes_no_promise_about_times) {
  const MadeRecording made = simulated_recording();
  const RunSummary summary = summarize(made.info, made.ticks);
  for (const char* key : {"deadline", "budget", "machine"}) EXPECT_EQ(state(summary, key), State::not_measured) << key;
  for (const Check& check : summary.checks) {
    if (check.key == "machine") {
      EXPECT_EQ(check.finding, "simulated time: stalls are not measured");
    }
    if (check.key == "budget") {
      EXPECT_EQ(check.finding,
                "2,000 work units for a query: counted work, without a clock; 7,000 work units for all of a step");
    }
  }
}

// A scene with a limit for steps only was told that no budget was set, and not whether its steps kept theirs.
TEST(RunSummary, the_limit_of_a_step_is_told_with_or_without_one_of_queries) {
  const auto finding = [](double budget_us, double frame_us, std::uint64_t frame_work_units) {
    MadeRecording made = calm_recording();
    made.info.budget_us = budget_us;
    made.info.frame_us = frame_us;
    made.info.frame_work_units = frame_work_units;
    made.info.frame_overshoot_us = 1.5;
    for (const Check& check : summarize(made.info, made.ticks).checks) {
      if (check.key == "budget") return check.finding;
    }
    return std::string();
  };
  constexpr double none = std::numeric_limits<double>::infinity();
  const std::uint64_t no_units = RunInfo{}.frame_work_units;
  EXPECT_EQ(finding(none, 330.0, no_units),
            "no query had a budget; all of a step in 330 µs: at most 1.50 µs beyond it");
  EXPECT_TRUE(finding(100.0, 330.0, 7000)
                  .ends_with("; all of a step in 330 µs and 7,000 work units: at most 1.50 µs "
                             "beyond it"));
  EXPECT_TRUE(finding(100.0, none, 7000).ends_with("; 7,000 work units for all of a step"));
  EXPECT_EQ(finding(none, none, no_units), "no query had a budget");
}

TEST_F(RunReport, says_which_limits_and_which_contacts_were_in_use) {
  MadeRecording made = simulated_recording();
  RunFiles files = write(made);
  std::string page = text_of(files.page);
  for (const char* row :
       {"<th>budget of a query</th><td>2,000 work units</td>", "<th>budget of a step</th><td>7,000 work units</td>",
        "<th>contacts of a pair</th><td>a patch of at most 8</td>", "<th>contacts of a step</th><td>at most 64</td>",
        "<td>carried along with the bodies"}) {
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
  for (const char* untrue : {"unlimited", "net of stalls", "query, net", "tick, net"}) {
    EXPECT_EQ(page.substr(0, page.find("<script")).find(untrue), std::string::npos) << untrue;
  }
  const auto json = nlohmann::json::parse(text_of(files.summary));
  EXPECT_EQ(json["run"]["work_units"], 2000);
  EXPECT_EQ(json["run"]["frame_work_units"], 7000);
  EXPECT_EQ(json["run"]["max_contacts"], 8);
  EXPECT_EQ(json["run"]["max_contacts_per_step"], 64);
  EXPECT_EQ(json["run"]["carry_motion"], 0.001);
  EXPECT_TRUE(json["run"]["budget_us"].is_null());
  EXPECT_TRUE(json["query"]["net"].is_null());
  EXPECT_TRUE(json["query"]["stall_share"].is_null());
  EXPECT_TRUE(json["latency"]["tick_net"].is_null());

  made = calm_recording();
  made.info.max_contacts = 1;
  files = write(made);
  page = text_of(files.page);
  for (const char* row : {"<th>budget of a step</th><td>none</td>", "<th>contacts of a pair</th><td>one</td>",
                          "<td>made anew in every step</td>", "query, net of stalls"}) {
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
  EXPECT_TRUE(nlohmann::json::parse(text_of(files.summary))["run"]["work_units"].is_null());
}

TEST(RunSummary, net_time_of_a_tick_is_the_smaller_of_its_two_bounds) {
  const auto longest_us = [](double stall_us, double processor_us) {
    MadeRecording made = calm_recording();  // awake for 150 us
    for (auto& tick : made.ticks) {
      tick.query_stall_us = stall_us;
      tick.processor_us = processor_us;
    }
    return 1e-3 * static_cast<double>(summarize(made.info, made.ticks).tick_net.max());
  };
  EXPECT_NEAR(longest_us(0.0, 0.0), 150.0, 0.5) << "nobody measured the thread's own time";
  EXPECT_NEAR(longest_us(30.0, 0.0), 120.0, 0.5);
  EXPECT_NEAR(longest_us(30.0, 140.0), 120.0, 0.5) << "a processor that was stolen looks busy to the system";
  EXPECT_NEAR(longest_us(30.0, 90.0), 90.0, 0.5) << "the thread lost the processor outside of a query";
}

TEST(RunSummary, what_nobody_counted_is_not_called_kept) {
  MadeRecording made = calm_recording();
  for (auto& tick : made.ticks) tick.allocations = haptics::not_measured;
  EXPECT_EQ(state(summarize(made.info, made.ticks), "memory"), State::not_measured);
  made.info.budget_us = std::numeric_limits<double>::infinity();
  EXPECT_EQ(state(summarize(made.info, made.ticks), "budget"), State::not_measured);
}

TEST(RunSummary, page_faults_of_simulated_time_are_shown_but_not_judged) {
  MadeRecording made = calm_recording();
  made.info.simulated_time = true;
  made.ticks[5].minor_faults = 1;
  const RunSummary summary = summarize(made.info, made.ticks);
  EXPECT_EQ(state(summary, "memory"), State::met) << "nothing is locked into memory then";
  EXPECT_EQ(summary.minor_faults, 1U);
  made.ticks[5].allocations = 1;
  EXPECT_EQ(state(summarize(made.info, made.ticks), "memory"), State::missed);
}

TEST(RunSummary, skipped_periods_count_with_the_time_until_the_next_force) {
  MadeRecording made;
  made.info.loop = {2, 3, false};
  haptics::TickRecord first;
  first.planned_ns = 0;
  first.done_ns = 100'000;
  haptics::TickRecord second;
  second.tick = 4;
  second.planned_ns = 4'000'000;
  second.done_ns = 4'300'000;
  second.skipped_before = 3;
  made.ticks = {first, second};
  const RunSummary summary = summarize(made.info, made.ticks);
  EXPECT_EQ(summary.tick.count(), 5u);
  for (const std::int64_t waited_ns : {100'000, 300'000, 1'300'000, 2'300'000, 3'300'000}) {
    EXPECT_EQ(summary.tick.counters()[summary.tick.counter_of(waited_ns)], 1u) << waited_ns;
  }
  EXPECT_EQ(summary.longest_miss_run, 3u);
}

TEST(RunSummary, periods_skipped_at_the_end_count_with_the_time_until_the_run_ended) {
  MadeRecording made;
  made.info.loop = {2, 5, false};
  haptics::TickRecord first;
  first.planned_ns = 0;
  first.done_ns = 100'000;
  haptics::TickRecord second;
  second.tick = 2;
  second.planned_ns = 2'000'000;
  second.done_ns = 7'200'000;
  second.skipped_before = 1;
  made.ticks = {first, second};
  const RunSummary summary = summarize(made.info, made.ticks);
  const auto holds_each_once = [](const Histogram& latencies) {
    EXPECT_EQ(latencies.count(), 7u);
    for (const std::int64_t waited_ns : {100'000, 5'200'000, 6'200'000, 4'200'000, 3'200'000, 2'200'000, 1'200'000}) {
      EXPECT_EQ(latencies.counters()[latencies.counter_of(waited_ns)], 1u) << waited_ns;
    }
  };
  holds_each_once(summary.tick);
  EXPECT_EQ(summary.longest_miss_run, 6u) << "one before the late tick, the tick, and four that never came";
  std::vector<HlogInterval> log;
  for_each_second(made.info, made.ticks, [&](const HlogInterval& interval) { log.push_back(interval); });
  ASSERT_FALSE(log.empty());
  holds_each_once(log.front().histogram);
  const auto data = nlohmann::json::parse(page_data(made.info, summary, made.ticks));
  EXPECT_EQ(data["time"]["skipped"], nlohmann::json({0, 5}));
}

TEST(RunSummary, periods_skipped_after_a_tick_that_was_in_time_waited_a_period_at_least) {
  MadeRecording made;
  made.info.loop = {1, 2, true};  // stopped while something else than the tick took the time
  haptics::TickRecord only;
  only.done_ns = 100'000;
  made.ticks = {only};
  const RunSummary summary = summarize(made.info, made.ticks);
  EXPECT_EQ(summary.tick.count(), 3u);
  EXPECT_EQ(summary.tick.max(), 2'000'000);
  EXPECT_EQ(summary.longest_miss_run, 2u);
  made.ticks.front().tick = 2;  // the records of the two before it were lost, so that nobody knows what was skipped
  made.info.loop = {3, 0, false};
  EXPECT_EQ(summarize(made.info, made.ticks).tick.count(), 1u);
}

TEST(RunSummary, percentiles_are_those_of_the_sorted_records) {
  const MadeRecording made = made_recording(3.0);
  const RunSummary summary = summarize(made.info, made.ticks);
  std::vector<double> net;
  for (const auto& tick : made.ticks) {
    if (tick.queries > 0) net.push_back(tick.query_net_us * 1e3);
  }
  std::sort(net.begin(), net.end());
  ASSERT_EQ(summary.query_net.count(), net.size());
  const double exact = net[static_cast<std::size_t>(0.99 * static_cast<double>(net.size()))];
  EXPECT_NEAR(static_cast<double>(summary.query_net.value_at_percentile(99.0)), exact, 2e-3 * exact);
}

TEST_F(RunReport, tables_have_a_row_for_every_tick_and_a_value_for_every_column) {
  const MadeRecording made = made_recording(2.0);
  std::istringstream csv(text_of(write(made).ticks));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line.rfind("tick,planned_ns,woke_ns,done_ns,", 0), 0u);
  const auto columns = std::count(line.begin(), line.end(), ',');
  std::size_t rows = 0;
  while (std::getline(csv, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns) << line;
    ++rows;
  }
  EXPECT_EQ(rows, made.ticks.size());
}

TEST_F(RunReport, summary_is_json_with_the_figures_of_the_histograms) {
  const MadeRecording made = made_recording(2.0);
  const RunFiles files = write(made);
  const auto json = nlohmann::json::parse(text_of(files.summary));
  const RunSummary summary = summarize(made.info, made.ticks);
  EXPECT_EQ(json["counts"]["planned"], 2'000);
  EXPECT_EQ(json["counts"]["ran"].get<std::uint64_t>() + json["counts"]["skipped"].get<std::uint64_t>(), 2'000u);
  EXPECT_EQ(json["latency"]["tick"]["max_us"].get<double>(), static_cast<double>(summary.tick.max()) * 1e-3);
  EXPECT_EQ(json["latency"]["wake"]["samples"], made.ticks.size());
  EXPECT_EQ(json["checks"].size(), summary.checks.size());

  std::ifstream hgrm(files.tick_latency);
  const auto table = read_hgrm(hgrm, "latency.hgrm");
  ASSERT_TRUE(table.ok()) << table.error().message();
  EXPECT_EQ(table.value().count, summary.tick.count());
  std::ifstream hlog(files.log);
  const auto log = read_hlog(hlog, "latency.hlog");
  ASSERT_TRUE(log.ok()) << log.error().message();
  std::uint64_t logged = 0;
  for (const HlogInterval& interval : log.value().intervals)
    logged += interval.tag.empty() ? interval.histogram.count() : 0;
  EXPECT_EQ(logged, summary.tick.count());
}

TEST_F(RunReport, numbers_that_are_not_finite_never_reach_json) {
  MadeRecording made = made_recording(1.0);
  made.info.budget_us = std::numeric_limits<double>::infinity();
  auto& tick = made.ticks[10];
  tick.query_gross_us = tick.query_stall_us = tick.max_depth_m = tick.probability =
      std::numeric_limits<double>::quiet_NaN();
  tick.force_n = {std::numeric_limits<double>::infinity(), 0.0, 0.0};
  const RunFiles files = write(made);
  const auto json = nlohmann::json::parse(text_of(files.summary));  // throws on nan and inf
  EXPECT_EQ(json["counts"]["not_finite"], 1);
  const std::string page = text_of(files.page);
  if (!pages_have_charts()) {
    EXPECT_EQ(page.find("<script"), std::string::npos) << "a page without charts needs no script";
    EXPECT_EQ(page.find("<canvas"), std::string::npos);
    return;
  }
  const auto begin = page.find("type=\"application/json\">") + 24;
  EXPECT_TRUE(nlohmann::json::accept(page.substr(begin, page.find("</script>", begin) - begin)));
}

TEST_F(RunReport, hostile_names_stay_text) {
  MadeRecording made = made_recording(1.0);
  const std::string evil =
      "</script><script>document.documentElement.dataset.evil=1</script><img src=x onerror=\"e('&')\">\xff";
  made.info.scene = made.info.device = made.info.version = made.info.bounding_volume = evil;
  made.info.effects = {evil};
  made.info.meshes[0] = {evil, evil, 1};
  made.info.host.push_back({evil, evil, realtime::HostLine::Readiness::good, evil});
  made.info.thread.push_back({evil, realtime::SetupLine::Outcome::refused, evil});
  made.info.fitness->reason = evil;
  const RunFiles files = write(made);
  const std::string page = text_of(files.page);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("dataset.evil=1</script>"), std::string::npos);
  EXPECT_TRUE(nlohmann::json::accept(text_of(files.summary)));
}

TEST_F(RunReport, repeats_the_warnings_of_the_program) {
  MadeRecording made = calm_recording();
  EXPECT_EQ(text_of(write(made).page).find("Warning:"), std::string::npos);
  made.info.warnings = {"stiff & <b>loud</b>", "second"};
  const RunFiles files = write(made);
  const std::string page = text_of(files.page);
  EXPECT_NE(page.find("<b>Warning:</b> stiff &amp; &lt;b&gt;loud&lt;/b&gt;</p>"), std::string::npos);
  EXPECT_NE(page.find("<b>Warning:</b> second</p>"), std::string::npos);
  const auto json = nlohmann::json::parse(text_of(directory_ / "summary.json"));
  EXPECT_EQ(json["warnings"], nlohmann::json(made.info.warnings));
}

TEST_F(RunReport, page_says_which_rows_have_skipped_periods_in_them) {
  MadeRecording made = calm_recording();
  made.ticks.back().tick += 3;
  made.ticks.back().skipped_before = 3;
  made.info.loop = {made.ticks.size(), 3, false};
  const RunSummary summary = summarize(made.info, made.ticks);
  EXPECT_EQ(summary.tick.count(), summary.ran + 3);
  EXPECT_EQ(summary.wake.count(), summary.ran);
  EXPECT_NE(text_of(write(made).page).find("skipped ones too; wake-ups are of those that ran"), std::string::npos);
}

TEST_F(RunReport, page_speaks_of_answers_without_proof_where_there_are_some) {
  MadeRecording made = made_recording(10.0);
  constexpr const char* others = "in the others the answer is the likelier one";
  EXPECT_NE(text_of(write(made).page).find(others), std::string::npos);
  for (haptics::TickRecord& tick : made.ticks) tick.basis = query::Basis::proved;
  EXPECT_EQ(text_of(write(made).page).find(others), std::string::npos);
}

TEST(Texts, times_that_no_clock_shows_are_unknown) {
  EXPECT_EQ(utc_time(0.0), "1970-01-01 00:00:00 UTC");
  EXPECT_EQ(utc_time(1714564800.5), "2024-05-01 12:00:00 UTC");
  EXPECT_EQ(utc_time(253402300799.0), "9999-12-31 23:59:59 UTC");
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double absurd : {1e300, -1e300, -1.0, 253402300800.0, infinity, -infinity, std::nan("")}) {
    EXPECT_EQ(utc_time(absurd), "unknown time") << absurd;
  }
}

TEST_F(RunReport, page_refers_to_nothing_outside_and_stays_small) {
  const std::string page = text_of(write(made_recording(10.0)).page);
  EXPECT_LT(page.size(), std::size_t{2} << 20);
  for (const char* attribute : {"src=\"", "href=\"h", "@import", "url("}) {
    EXPECT_EQ(page.find(attribute), std::string::npos) << attribute;
  }
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
}

TEST_F(RunReport, page_of_a_scene_without_a_hand_shows_no_force_on_it) {
  MadeRecording made = calm_recording();
  const std::string with = text_of(write(made).page);
  EXPECT_NE(with.find("Largest force"), std::string::npos);
  made.info.device = "none";
  const std::string without = text_of(write(made).page);
  EXPECT_EQ(without.find("Largest force"), std::string::npos);
  EXPECT_NE(without.find("no force was sent to a hand"), std::string::npos);
  for (const char* chart : {"id=\"chart-force\"", "id=\"chart-torque\"", "id=\"chart-energy\""}) {
    EXPECT_EQ(without.find(chart), std::string::npos) << chart;
    if (pages_have_charts()) {
      EXPECT_NE(with.find(chart), std::string::npos) << chart;
    }
  }
}

TEST_F(RunReport, an_empty_run_still_gives_files_that_can_be_read) {
  MadeRecording made;
  made.info.scene = "nothing";
  const RunFiles files = write(made);
  EXPECT_TRUE(nlohmann::json::accept(text_of(files.summary)));
  EXPECT_NE(text_of(files.page).find("</html>"), std::string::npos);
}

TEST_F(RunReport, says_which_file_cannot_be_written) {
  std::ofstream(directory_.string()) << "a file where the directory should be";
  const MadeRecording made = calm_recording();
  const auto files = write_run_report(directory_, made.info, summarize(made.info, made.ticks), made.ticks);
  ASSERT_FALSE(files.ok());
  EXPECT_NE(files.error().message().find(directory_.string()), std::string::npos);
}

}  // namespace
}  // namespace odds::report
