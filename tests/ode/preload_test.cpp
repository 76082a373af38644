// The preload library in a program that knows nothing of it.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "ode/ode_fixture.hpp"

namespace odds::test {
namespace {

struct ClientRun {
  std::string output;  // both streams
  int status = -1;
  double moved_mm = -1.0;
  int contacts = -1;
  int sideways = -1;
};

class Preload : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::string(ODDS_PRELOAD).empty()) GTEST_SKIP() << "not for this system, or a sanitizer must be loaded first";
    page = std::filesystem::path(::testing::TempDir()) /
           ("odds_preload_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) + ".txt");
  }
  void TearDown() override { std::filesystem::remove(page); }

  // The client with these variables in its environment.
  static ClientRun run(const std::string& variables, bool preloaded) {
    ClientRun result;
    std::ostringstream command;
    command << "timeout 60 env " << variables;  // a deadlock is a failure
    if (preloaded) command << " LD_PRELOAD=\"" ODDS_PRELOAD "\"";
    command << " \"" ODDS_PRELOAD_CLIENT "\" 2>&1";
    FILE* pipe = popen(command.str().c_str(), "r");
    if (pipe == nullptr) return result;
    char line[512];
    while (std::fgets(line, sizeof line, pipe) != nullptr) {
      result.output += line;
      std::sscanf(line, "moved_mm %lf contacts %d sideways %d", &result.moved_mm, &result.contacts, &result.sideways);
    }
    result.status = pclose(pipe);
    return result;
  }
  [[nodiscard]] std::string read_page() const {
    std::ifstream file(page);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::filesystem::path page;
};

TEST_F(Preload, BricksOfAnUnchangedProgramStandAndThePageCountsThem) {
  const ClientRun alone = run("ODDS_REPORT=off", false);
  ASSERT_EQ(alone.status, 0) << alone.output;
  EXPECT_GT(alone.sideways, 0) << "ODE's own collider: the reason for all this";
  const ClientRun with = run("ODDS_BUDGET_US=1e9 ODDS_REPORT=" + page.string(), true);
  ASSERT_EQ(with.status, 0) << with.output;
  EXPECT_EQ(with.sideways, 0);
  EXPECT_GT(with.contacts, 4000);
  EXPECT_LT(with.moved_mm, 1.0);
  EXPECT_LT(with.moved_mm, alone.moved_mm);
  const std::string text = read_page();
  EXPECT_NE(text.find("dTriMesh"), std::string::npos) << text;
  EXPECT_NE(text.find("p99.9 us"), std::string::npos) << text;
  EXPECT_NE(text.find("prepared inside the loop: 0 meshes"), std::string::npos) << text;
}

TEST_F(Preload, PartnersThatAreNotTakenStayWithOde) {
  const ClientRun alone = run("ODDS_REPORT=off", false);
  const ClientRun with = run("ODDS_PARTNERS=sphere,ray ODDS_REPORT=-", true);
  ASSERT_EQ(with.status, 0) << with.output;
  EXPECT_EQ(with.contacts, alone.contacts);
  EXPECT_EQ(with.moved_mm, alone.moved_mm);
  EXPECT_NE(with.output.find("\nnone: no dTriMesh geom"), std::string::npos) << with.output;
}

TEST_F(Preload, AMeshWhoseVerticesTheProgramMovesIsOdesFromThenOn) {
  const auto changed = [](const ClientRun& client) {
    const std::string label = "changed meshes: ";
    const std::size_t at = client.output.find(label);
    return at == std::string::npos ? -1 : std::stoi(client.output.substr(at + label.size()));
  };
  const ClientRun still = run("ODDS_REPORT=-", true);
  ASSERT_EQ(still.status, 0) << still.output;
  EXPECT_EQ(changed(still), 0) << still.output;
  const ClientRun moved = run("DEFORM=1 ODDS_REPORT=-", true);
  ASSERT_EQ(moved.status, 0) << moved.output;
  EXPECT_GT(changed(moved), 500) << "as often as the lower brick meets the ground\n" << moved.output;
  EXPECT_LE(changed(moved), 1000) << moved.output;
}

// The library waited for itself: what it made to read the mesh was prepared like one of the program's.
TEST_F(Preload, AMeshThatCannotBeReadWhenItIsMadeHoldsNothingUp) {
  const ClientRun client = run("LATE_DATA=1 ODDS_REPORT=off", true);
  ASSERT_EQ(client.status, 0) << client.output;
  EXPECT_NE(client.output.find("late_data "), std::string::npos) << client.output;
  EXPECT_EQ(client.output.find("late_data 0"), std::string::npos) << client.output;
}

TEST_F(Preload, MistakesInTheEnvironmentAreToldAndHarmless) {
  const ClientRun with = run("ODDS_BUDGET_US=soon ODDS_PARTNERS=trimesh,teapot ODDS_REPORT=/nowhere/at/all", true);
  ASSERT_EQ(with.status, 0) << with.output;
  EXPECT_NE(with.output.find("ODDS_BUDGET_US=soon"), std::string::npos) << with.output;
  EXPECT_NE(with.output.find("teapot"), std::string::npos) << with.output;
  EXPECT_NE(with.output.find("/nowhere/at/all cannot be written"), std::string::npos) << with.output;
  EXPECT_NE(with.output.find("collisions of dTriMesh geoms"), std::string::npos) << "then it goes to standard error";
  EXPECT_EQ(with.sideways, 0);
}

TEST_F(Preload, FractionsOfWholeNumbersAndListsWithoutAPartnerAreMistakes) {
  const ClientRun with =
      run("ODDS_WORK_UNITS=0.5 ODDS_MAX_CONTACTS=1.5 ODDS_PARTNERS=none ODDS_REPORT=off ODDS_BUDGET_US=99.5", true);
  ASSERT_EQ(with.status, 0) << with.output;
  EXPECT_NE(with.output.find("ODDS_WORK_UNITS=0.5 is not a whole number in range"), std::string::npos) << with.output;
  EXPECT_NE(with.output.find("ODDS_MAX_CONTACTS=1.5 is not a whole number"), std::string::npos) << with.output;
  EXPECT_NE(with.output.find("no known partner is left"), std::string::npos) << with.output;
  EXPECT_EQ(with.output.find("ODDS_BUDGET_US"), std::string::npos) << with.output;
  const ClientRun spaced = run("ODDS_PARTNERS=' sphere, ray' ODDS_REPORT=-", true);
  EXPECT_EQ(spaced.output.find("unknown"), std::string::npos) << spaced.output;
}

TEST_F(Preload, NumbersAreReadAlikeInEveryLocale) {
  const ClientRun with = run("COMMAS=1 ODDS_BUDGET_US=99.5 ODDS_REPORT=off", true);
  ASSERT_EQ(with.status, 0) << with.output;
  if (with.output.find("commas") == std::string::npos) GTEST_SKIP() << "no locale with decimal commas";
  EXPECT_EQ(with.output.find("ODDS_BUDGET_US"), std::string::npos) << with.output;
}

// Its code had never run: the system brought its pages one by one, which took longer than a budget, and the ray met
// nothing. Three at least without warming up; with it one at most, unless the system takes them away again.
TEST_F(Preload, TheFirstRayOfAProcessFindsItsCodeReady) {
  long fewest = 1000;
  for (int i = 0; i < 10 && fewest > 1; ++i) {
    const ClientRun client = run("ONE_RAY=1 ODDS_BUDGET_US=1e9 ODDS_REPORT=" + page.string(), true);
    ASSERT_EQ(client.status, 0) << client.output;
    int contacts = -1;
    long page_faults = -1;
    const std::size_t told = client.output.find("one_ray ");
    ASSERT_NE(told, std::string::npos) << client.output;
    ASSERT_EQ(std::sscanf(client.output.c_str() + told, "one_ray %d page_faults %ld", &contacts, &page_faults), 2);
    EXPECT_EQ(contacts, 1);
    fewest = std::min(fewest, page_faults);
  }
  EXPECT_LE(fewest, 1);
  const std::string text = read_page();
  const std::size_t row = text.find("\nray ");
  ASSERT_NE(row, std::string::npos) << text;
  int collisions = 0;
  EXPECT_EQ(std::sscanf(text.c_str() + row, " ray %d", &collisions), 1);
  EXPECT_EQ(collisions, 1) << "what warms up is not counted\n" << text;
  EXPECT_EQ(text.find("\nsphere"), std::string::npos) << text;
  EXPECT_NE(text.find("others ended by their budget: 0"), std::string::npos) << text;
}

// ODE's own default. Its numbers were read as doubles.
TEST_F(Preload, AnOdeInSinglePrecisionIsLeftAloneAndThatIsSaid) {
  const ClientRun alone = run("ODDS_REPORT=off", false);
  const ClientRun with = run("SINGLE=1 ODDS_REPORT=" + page.string(), true);
  ASSERT_EQ(with.status, 0) << with.output;
  EXPECT_NE(with.output.find("single precision"), std::string::npos) << with.output;
  EXPECT_EQ(with.contacts, alone.contacts);
  EXPECT_EQ(with.moved_mm, alone.moved_mm);
  EXPECT_FALSE(std::filesystem::exists(page));
}

// Nothing was said, as if it had been taken over.
TEST_F(Preload, AProgramThatLooksUpOdesFunctionsIsToldThatItIsNotTakenOver) {
  const std::string sentence = "looked up ODE's functions by itself";
  const ClientRun told = run("LOOKED_UP=1 ODDS_REPORT=" + page.string(), true);
  ASSERT_EQ(told.status, 0) << told.output;
  EXPECT_NE(told.output.find(sentence), std::string::npos) << told.output;
  const ClientRun quiet = run("LOOKED_UP=1 ODDS_REPORT=off", true);
  EXPECT_EQ(quiet.output.find(sentence), std::string::npos) << quiet.output;
  const ClientRun linked = run("ONE_RAY=1 ODDS_REPORT=-", true);
  EXPECT_EQ(linked.output.find(sentence), std::string::npos) << linked.output;
}

// A child told of its parent's collisions as well, one without any too, and in the place of the parent's page; and a
// file without a folder was where the program had gone.
TEST_F(Preload, EveryProcessTellsOfItsOwnCollisionsWhereItWasStarted) {
  const auto occurrences = [](const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  };
  const std::string one_ray = "\nray                 1 ";
  const ClientRun told = run("FORKS=1 ODDS_REPORT=-", true);
  ASSERT_EQ(told.status, 0) << told.output;
  EXPECT_EQ(occurrences(told.output, "collisions of dTriMesh geoms"), 2) << told.output;
  EXPECT_EQ(occurrences(told.output, one_ray), 2) << told.output;

  const std::filesystem::path folder = page.string() + "_pages";
  std::filesystem::create_directories(folder);
  const ClientRun written = run("--chdir=" + folder.string() + " FORKS=1 ODDS_REPORT=page.%p", true);
  EXPECT_EQ(written.status, 0) << written.output;
  int pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path());
    const std::string text(std::istreambuf_iterator<char>(file), {});
    EXPECT_EQ(occurrences(text, one_ray), 1) << text;
    const std::string process = entry.path().filename().string().substr(std::string("page.").size());
    EXPECT_NE(text.find("process " + process + ")"), std::string::npos) << entry.path() << text;
    ++pages;
  }
  EXPECT_EQ(pages, 2);
  std::filesystem::remove_all(folder);
}

// ODE was held open, and its room for classes filled up.
TEST_F(Preload, AProgramMayCloseOdeAndUseItAgainWithAClassOfItsOwn) {
  const ClientRun alone = run("CYCLES=1", false);
  ASSERT_EQ(alone.status, 0) << alone.output;
  const ClientRun with = run("CYCLES=1 ODDS_BUDGET_US=1e9 ODDS_REPORT=" + page.string(), true);
  ASSERT_EQ(with.status, 0) << with.output;
  EXPECT_EQ(with.sideways, 0) << "taken over anew";
  EXPECT_GT(with.contacts, 4000);
  EXPECT_NE(read_page().find("dTriMesh "), std::string::npos);
}

}  // namespace
}  // namespace odds::test
