// `odds query` on two copies of a car body of 60,000 triangles, row by row against FCL.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "support/run_tool.hpp"

namespace odds {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::string& text) {
  std::vector<Row> rows;
  std::vector<std::string> names;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream fields(line);
    std::vector<std::string> values;
    for (std::string field; std::getline(fields, field, ',');) values.push_back(field);
    if (names.empty()) {
      names = values;
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = i < values.size() ? values[i] : "";
    rows.push_back(row);
  }
  return rows;
}

constexpr const char* car = "made:car_body:triangles=60000";
constexpr std::size_t count = 1008;  // 72 first touches in 14 bands

class CarBodies : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new testing::TemporaryFolder;
    const std::string command = std::string("'") + ODDS_NEAR_POSES + "' " + car + " " + car + " " +
                                std::to_string(count) + " 7 '" + (*folder_ / "poses.csv") + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    poses_ = rows_of(testing::contents_of(*folder_ / "poses.csv"));
    ASSERT_EQ(poses_.size(), count);
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::vector<Row> query(const std::string& options) {
    const auto ran = testing::run_tool(
        *folder_, std::string("query ") + car + " " + car + " --poses poses.csv --out a.csv " + options);
    EXPECT_EQ(ran.status, 0) << ran.errors;
    auto rows = rows_of(testing::contents_of(*folder_ / "a.csv"));
    EXPECT_EQ(rows.size(), count);
    return rows;
  }

  static inline testing::TemporaryFolder* folder_ = nullptr;
  static inline std::vector<Row> poses_;
};

TEST_F(CarBodies, VerdictsWithoutABudgetAreFcls) {
  for (const char* method : {"exact", "time-critical", "incremental"}) {
    const auto answers = query(std::string("--method ") + method);
    ASSERT_EQ(answers.size(), count);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(answers[i].at("verdict"), poses_[i].at("fcl") == "1" ? "hit" : "clear")
          << method << " row " << i << " band " << poses_[i].at("band");
      EXPECT_EQ(answers[i].at("basis"), "proved");
      hits += answers[i].at("verdict") == "hit" ? 1 : 0;
    }
    EXPECT_GT(hits, count / 3);
    EXPECT_LT(hits, count * 3 / 4);
  }
}

TEST_F(CarBodies, EveryPoseIsAnsweredWithinABudgetAndProofsAreRight) {
  // How many are proved within some time is the machine's affair; within some work it is ours.
  for (const char* budget : {"--budget-us 20", "--work 1000"}) {
    std::size_t proved = 0;
    for (const Row& row : query(budget)) {
      const double p = std::stod(row.at("probability"));
      EXPECT_TRUE(p >= 0.0 && p <= 1.0);
      EXPECT_TRUE(row.at("verdict") == "hit" || row.at("verdict") == "clear");
      if (row.at("basis") != "proved") continue;
      ++proved;
      EXPECT_EQ(row.at("verdict"), poses_[std::stoul(row.at("row"))].at("fcl") == "1" ? "hit" : "clear")
          << budget << ": a proof must be right";
    }
    if (std::string_view(budget) != "--work 1000") continue;
    EXPECT_GT(proved, count / 2);
  }
}

}  // namespace
}  // namespace odds
