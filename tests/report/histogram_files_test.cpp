// The files of HdrHistogram: against golden files that an independent implementation (npm hdr-histogram-js 3.0.1) read,
// printed and wrote; against that implementation itself where it is installed; and against damaged input.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <clocale>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "odds/report/hgrm.hpp"
#include "odds/report/hlog.hpp"
#include "report/golden_log.hpp"

namespace odds::report {
namespace {

namespace fs = std::filesystem;

const fs::path data = fs::path(ODDS_SOURCE_DIR) / "tests/report/data";

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.good()) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

Hlog golden_read() {
  std::ifstream file(data / "golden.hlog");
  Result<Hlog> log = read_hlog(file, "golden.hlog");
  EXPECT_TRUE(log.ok()) << log.error().message();
  return log.value();
}

/// The figures that the independent implementation printed about the golden log, against ours.
void expect_same_figures(const Hlog& log, const nlohmann::json& figures) {
  ASSERT_EQ(log.intervals.size(), figures.size());
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const HlogInterval& ours = log.intervals[i];
    const nlohmann::json& theirs = figures[i];
    EXPECT_EQ(ours.tag, theirs["tag"]);
    EXPECT_EQ(ours.start_s, theirs["start"]);
    EXPECT_EQ(ours.length_s, theirs["length"]);
    EXPECT_EQ(ours.histogram.count(), theirs["count"]);
    EXPECT_EQ(ours.histogram.max(), theirs["max"]);
    EXPECT_NEAR(ours.histogram.mean(), theirs["mean"].get<double>(), 1e-9 * theirs["mean"].get<double>());
    for (const auto& pair : theirs["percentiles"]) {
      EXPECT_EQ(ours.histogram.value_at_percentile(pair[0]), pair[1]) << "percentile " << pair[0];
    }
  }
}

TEST(HistogramFiles, our_log_is_still_the_golden_log) {
  std::ostringstream written;
  write_hlog(written, golden_log());
  std::istringstream again(written.str());
  const Result<Hlog> ours = read_hlog(again, "written");
  ASSERT_TRUE(ours.ok()) << ours.error().message();
  const Hlog golden = golden_read();
  ASSERT_EQ(ours.value().intervals.size(), golden.intervals.size());
  for (std::size_t i = 0; i < golden.intervals.size(); ++i) {  // not byte by byte: zlib may pack differently
    const auto a = ours.value().intervals[i].histogram.counters();
    const auto b = golden.intervals[i].histogram.counters();
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end())) << i;
  }
}

/// The C library's numbers have commas while it lives, if the system has a locale of such.
class NumbersWithCommas {
 public:
  NumbersWithCommas() {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR"}) {
      if (std::setlocale(LC_NUMERIC, name) != nullptr) break;
    }
  }
  ~NumbersWithCommas() { std::setlocale(LC_NUMERIC, "C"); }
  NumbersWithCommas(const NumbersWithCommas&) = delete;
  NumbersWithCommas& operator=(const NumbersWithCommas&) = delete;
  [[nodiscard]] bool have() const { return std::localeconv()->decimal_point[0] == ','; }
};

TEST(HistogramFiles, are_the_same_in_every_locale) {
  const auto written = [](Hlog& log, HgrmTable& table) {
    std::stringstream as_log;
    write_hlog(as_log, golden_log());
    std::stringstream as_table;
    write_hgrm(as_table, golden_log().intervals.front().histogram);
    Result<Hlog> read = read_hlog(as_log, "log");
    EXPECT_TRUE(read.ok()) << read.error().message();
    if (read.ok()) log = std::move(read).value();
    Result<HgrmTable> rows = read_hgrm(as_table, "table");
    EXPECT_TRUE(rows.ok()) << rows.error().message();
    if (rows.ok()) table = std::move(rows).value();
    return as_log.str() + as_table.str();
  };
  Hlog log;
  HgrmTable table;
  const std::string plain = written(log, table);
  const NumbersWithCommas commas;
  if (!commas.have()) GTEST_SKIP() << "no locale with decimal commas";
  Hlog again;
  HgrmTable rows;
  EXPECT_EQ(written(again, rows), plain);
  EXPECT_EQ(again.start_epoch_s, log.start_epoch_s);
  EXPECT_EQ(rows.mean, table.mean);
  EXPECT_EQ(rows.max, table.max);
  ASSERT_EQ(rows.rows.size(), table.rows.size());
  EXPECT_EQ(rows.rows[1].value, table.rows[1].value);
  EXPECT_GT(table.mean, 0.0);
}

TEST(HistogramFiles, our_reader_finds_the_figures_that_the_independent_reader_found) {
  expect_same_figures(golden_read(), nlohmann::json::parse(text_of(data / "golden_figures.json")));
}

TEST(HistogramFiles, our_reader_reads_what_the_independent_writer_wrote) {
  std::istringstream lines(text_of(data / "golden_theirs.txt"));
  const Hlog golden = golden_read();
  std::string line;
  std::size_t i = 0;
  for (; std::getline(lines, line); ++i) {
    const Result<Histogram> theirs = decode_histogram(line);
    ASSERT_TRUE(theirs.ok()) << theirs.error().message();
    ASSERT_LT(i, golden.intervals.size());
    const auto a = theirs.value().counters();
    const auto b = golden.intervals[i].histogram.counters();
    for (std::size_t counter = 0; counter < std::min(a.size(), b.size()); ++counter) ASSERT_EQ(a[counter], b[counter]);
    EXPECT_EQ(theirs.value().count(), golden.intervals[i].histogram.count());
  }
  EXPECT_EQ(i, golden.intervals.size());
}

TEST(HistogramFiles, our_percentile_table_is_theirs_line_by_line) {
  std::ostringstream written;
  write_hgrm(written, golden_read().intervals.front().histogram);
  std::istringstream ours(written.str());
  std::istringstream theirs(text_of(data / "golden.hgrm"));
  std::string our_line;
  std::string their_line;
  while (std::getline(theirs, their_line)) {
    ASSERT_TRUE(std::getline(ours, our_line)) << "ours is shorter";
    // Ties in the twelfth digit of the percentile: JavaScript rounds them up, the C library to even.
    if (our_line.size() == their_line.size() && our_line.size() > 27 && our_line[0] != '#') {
      EXPECT_NEAR(std::atof(our_line.substr(12, 15).c_str()), std::atof(their_line.substr(12, 15).c_str()), 1.1e-12);
      our_line.replace(12, 15, "");
      their_line.replace(12, 15, "");
    }
    EXPECT_EQ(our_line, their_line);
  }
  EXPECT_FALSE(std::getline(ours, our_line)) << "ours is longer: " << our_line;
}

TEST(HistogramFiles, the_percentile_table_can_be_read_back) {
  std::ifstream file(data / "golden.hgrm");
  const Result<HgrmTable> table = read_hgrm(file, "golden.hgrm");
  ASSERT_TRUE(table.ok()) << table.error().message();
  EXPECT_EQ(table.value().count, 20'009u);
  EXPECT_EQ(table.value().rows.back().total_count, 20'009u);
  EXPECT_DOUBLE_EQ(table.value().rows.back().fraction, 1.0);
  EXPECT_DOUBLE_EQ(table.value().mean, 180485.522);
}

TEST(HistogramFiles, an_empty_histogram_survives_both_formats) {
  const Result<Histogram> again = decode_histogram(encode_histogram(Histogram()));
  ASSERT_TRUE(again.ok()) << again.error().message();
  EXPECT_EQ(again.value().count(), 0u);
  std::ostringstream text;
  write_hgrm(text, Histogram());
  std::istringstream back(text.str());
  const Result<HgrmTable> table = read_hgrm(back, "empty");
  ASSERT_TRUE(table.ok()) << table.error().message();
  EXPECT_TRUE(table.value().rows.empty());
}

TEST(HistogramFiles, the_independent_reader_agrees_where_it_is_installed) {
  const fs::path log = fs::temp_directory_path() / ("odds_golden_" + std::to_string(std::rand()) + ".hlog");
  {
    std::ofstream file(log);
    write_hlog(file, golden_log());
  }
  const std::string command = "node '" + (fs::path(ODDS_SOURCE_DIR) / "tests/report/read_hlog.cjs").string() + "' '" +
                              log.string() + "' 2>/dev/null";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string output;
  std::array<char, 4096> block{};
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), pipe)) output.append(block.data(), got);
  const int status = ::pclose(pipe);
  fs::remove(log);
  if (status != 0 && output.empty()) GTEST_SKIP() << "node or its package hdr-histogram-js is not installed";
  ASSERT_EQ(status, 0);
  expect_same_figures(golden_read(), nlohmann::json::parse(output));
}

// Damaged input: the reader may refuse or accept, it must neither crash nor take memory beyond its limit.

RC_GTEST_PROP(HistogramFiles, damaged_encodings_are_refused_or_read_but_never_crash, ()) {
  std::string text = encode_histogram(golden_log().intervals.front().histogram);
  const int edits = *rc::gen::inRange(1, 8);
  for (int i = 0; i < edits; ++i) {
    const auto at = static_cast<std::size_t>(*rc::gen::inRange<std::uint64_t>(0, text.size()));
    text[at] = *rc::gen::element('A', 'B', 'z', '9', '+', '/', '=', '\0', ',');
  }
  text.resize(*rc::gen::inRange<std::size_t>(0, text.size() + 1));
  const Result<Histogram> result = decode_histogram(text);
  if (!result) RC_ASSERT(!result.error().what.empty());
}

RC_GTEST_PROP(HistogramFiles, any_bytes_are_a_safe_log, (const std::string& bytes)) {
  for (const std::string& start : {std::string(), std::string("#[Histogram log format version 1.3]\n0,1,2,")}) {
    std::istringstream log(start + bytes);
    const Result<Hlog> result = read_hlog(log, "made up");
    if (!result) RC_ASSERT(result.error().file == "made up");
  }
  std::istringstream table("Value Percentile\n" + bytes);
  const Result<HgrmTable> read = read_hgrm(table, "made up");
  if (read && !read.value().rows.empty()) RC_ASSERT(read.value().rows.back().total_count == read.value().count);
}

struct BadLog {
  const char* name;
  const char* text;
  const char* says;
};

class DamagedLog : public ::testing::TestWithParam<BadLog> {};

TEST_P(DamagedLog, is_refused_with_its_line_and_cause) {
  std::istringstream in(GetParam().text);
  const Result<Hlog> log = read_hlog(in, "x.hlog");
  ASSERT_FALSE(log.ok());
  EXPECT_NE(log.error().message().find(GetParam().says), std::string::npos) << log.error().message();
}

INSTANTIATE_TEST_SUITE_P(
    HistogramFiles, DamagedLog,
    ::testing::Values(
        BadLog{"empty", "", "x.hlog:0: the line with the format version is missing"},
        BadLog{"no_version", "0,1,2,AAAA\n", "x.hlog:1:"},
        BadLog{"few_fields", "#[Histogram log format version 1.3]\n0,1\n", "x.hlog:2: not a line of start"},
        BadLog{"not_a_number", "#[Histogram log format version 1.3]\nnan,1,2,AAAA\n", "x.hlog:2: not a line"},
        BadLog{"not_base64", "#[Histogram log format version 1.3]\n0,1,2,A!AA\n", "not base64"},
        BadLog{"wrong_cookie", "#[Histogram log format version 1.3]\n0,1,2,AAAAAAAAAAAAAAAA\n", "cookie"},
        BadLog{"cut_off", "#[Histogram log format version 1.3]\n0,1,2,HISTFAAAAQQ=\n", "cut off"}),
    [](const auto& test) { return test.param.name; });

TEST(HistogramFiles, a_damaged_percentile_table_is_refused_with_its_line) {
  for (const char* text : {"", "nonsense\n", "Value Percentile\n1 2\n", "Value Percentile\n1 0.5 3\n0.5 0.9 4\n",
                           "Value Percentile\nnan 0.5 3\n", "Value Percentile\n1 1.5 3\n",
                           "Value Percentile\n1 1.0 3\n#[Max = 1, Total count = 4]\n"}) {
    std::istringstream in(text);
    const Result<HgrmTable> table = read_hgrm(in, "x.hgrm");
    ASSERT_FALSE(table.ok()) << text;
    EXPECT_EQ(table.error().file, "x.hgrm");
    EXPECT_FALSE(table.error().place.empty());
  }
}

}  // namespace
}  // namespace odds::report
