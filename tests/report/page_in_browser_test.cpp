// Opens the page in a real browser, where there is one, and asks it what it drew.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "odds/mesh/made/by_name.hpp"
#include "odds/report/run_report.hpp"
#include "report/made_recording.hpp"

namespace odds::report {
namespace {

namespace fs = std::filesystem;

/// The page as the browser sees it after its scripts ran; empty without a browser.
std::string rendered(const fs::path& page, const fs::path& profile) {
  const std::string command =
      "timeout 60 chromium --headless --no-sandbox --disable-gpu --use-gl=swiftshader --enable-unsafe-swiftshader "
      "--disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync --user-data-dir='" +
      profile.string() + "' --window-size=1400,3000 --virtual-time-budget=4000 --dump-dom 'file://" + page.string() +
      "' 2>/dev/null";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string dom;
  std::array<char, 1 << 14> block{};
  while (const std::size_t got = std::fread(block.data(), 1, block.size(), pipe)) dom.append(block.data(), got);
  ::pclose(pipe);
  return dom;
}

/// The opening tag of the page's root element, where the page's script leaves its marks.
std::string root_of(const std::string& dom) {
  const auto begin = dom.find("<html");
  return begin == std::string::npos ? std::string() : dom.substr(begin, dom.find('>', begin) - begin);
}

/// The number in an attribute of the root element; -1 if it has none of that name.
long root_number(const std::string& dom, const std::string& attribute) {
  const std::string root = root_of(dom);
  const auto at = root.find(attribute + "=\"");
  return at == std::string::npos ? -1 : std::atol(root.c_str() + at + attribute.size() + 2);
}

class PageInBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!pages_have_charts()) GTEST_SKIP() << "built without a chart library";
    if (std::system("command -v chromium >/dev/null 2>&1") != 0) GTEST_SKIP() << "chromium is not installed";
    directory_ = fs::temp_directory_path() / ("odds_page_" + std::to_string(::getpid()));
  }
  void TearDown() override { fs::remove_all(directory_); }

  std::string open(const MadeRecording& made, const RunReplay* replay = nullptr) {
    const auto files = write_run_report(directory_, made.info, summarize(made.info, made.ticks), made.ticks, replay);
    EXPECT_TRUE(files.ok()) << files.error().message();
    std::string dom = rendered(files.value().page, directory_ / "profile");
    EXPECT_NE(dom.find("<html"), std::string::npos) << "the browser gave no page";
    return dom;
  }

  fs::path directory_;
};

TEST_F(PageInBrowser, draws_all_charts_without_an_error) {
  const std::string dom = open(made_recording(4.0));
  ASSERT_NE(dom.find("<html"), std::string::npos);
  EXPECT_EQ(root_of(dom).find("data-error"), std::string::npos) << root_of(dom);
  EXPECT_EQ(root_number(dom, "data-charts"), 11);
  EXPECT_GT(root_number(dom, "data-points"), 20'000);
}

TEST_F(PageInBrowser, an_empty_run_and_hostile_names_neither_break_nor_run_anything) {
  MadeRecording made;
  made.info.scene = "</title><script>document.documentElement.dataset.evil=1</script>";
  const std::string dom = open(made);
  ASSERT_NE(dom.find("<html"), std::string::npos);
  EXPECT_EQ(root_of(dom).find("data-error"), std::string::npos) << root_of(dom);
  EXPECT_EQ(root_of(dom).find("data-evil"), std::string::npos);
  EXPECT_GE(root_number(dom, "data-charts"), 2);
}

TEST_F(PageInBrowser, draws_the_replay) {
  if (!pages_have_replay()) GTEST_SKIP() << "built without a library for three dimensions";
  const MadeRecording made = made_recording(2.0);
  const auto ball = mesh::made::make_shape("made:icosphere:radius=0.02");
  const auto plate = mesh::made::make_shape("made:box:x=0.2,y=0.2,z=0.02");
  ASSERT_TRUE(ball.ok() && plate.ok());
  RunReplay replay;
  replay.meshes = {simplified(ball.value(), 20'000), simplified(plate.value(), 20'000)};
  replay.bodies = {{"plate </script><b>", 1, false, false, {}}, {"tool", 0, true, true, {}}};
  for (std::uint64_t tick = 0; tick < 2000; tick += 10) {
    math::Pose pose;
    pose.translation.z() = 0.03 + 0.01 * std::sin(0.01 * static_cast<double>(tick));
    replay.frames.push_back({tick, {pose}});
  }
  const std::string dom = open(made, &replay);
  ASSERT_NE(dom.find("<html"), std::string::npos);
  EXPECT_EQ(root_of(dom).find("data-error"), std::string::npos) << root_of(dom);
  EXPECT_EQ(root_number(dom, "data-replay-frames"), 200);
  EXPECT_EQ(root_number(dom, "data-replay-triangles"),
            static_cast<long>(replay.meshes[0].triangles.size() + replay.meshes[1].triangles.size()));
  EXPECT_GT(root_number(dom, "data-replay-drawn"), 5'000) << root_of(dom);
}

TEST(ReplayMesh, VerticesOfNoTriangleAreNotShown) {
  // Far off, they would have the eye stand where nothing is seen, and draw the cell in which they end out of place.
  const auto torus = mesh::made::make_shape("made:torus");
  ASSERT_TRUE(torus.ok());
  std::vector<Vec3> vertices = {Vec3::Constant(-1e3)};
  std::vector<mesh::Triangle> triangles;
  for (const Vec3& v : torus.value().vertices()) vertices.push_back(v);
  for (const mesh::Triangle& t : torus.value().triangles()) triangles.push_back({t[0] + 1, t[1] + 1, t[2] + 1});
  vertices.push_back(Vec3::Constant(1e3));
  const auto mesh = mesh::TriangleMesh::make(std::move(vertices), std::move(triangles));
  ASSERT_TRUE(mesh.ok());
  for (const std::size_t most : {torus.value().triangles().size(), torus.value().triangles().size() / 5}) {
    const ReplayMesh expected = simplified(torus.value(), most);
    const ReplayMesh shown = simplified(mesh.value(), most);
    EXPECT_EQ(shown.vertices, expected.vertices);
    EXPECT_EQ(shown.triangles, expected.triangles);
  }
}

TEST(ReplayMesh, IsSimplifiedToTheNumberAskedForAndKeepsItsPlace) {
  const auto torus = mesh::made::make_shape("made:torus_knot");
  ASSERT_TRUE(torus.ok());
  const std::size_t all = torus.value().triangles().size();
  EXPECT_EQ(simplified(torus.value(), all).triangles.size(), all);
  const ReplayMesh small = simplified(torus.value(), all / 5);
  EXPECT_LE(small.triangles.size(), all / 5);
  EXPECT_GT(small.triangles.size(), all / 25);
  EXPECT_EQ(small.triangles_of_mesh, all);
  for (const mesh::Triangle& t : small.triangles) {
    for (const std::uint32_t i : t) ASSERT_LT(i, small.vertices.size());
  }
  Vec3 lower = Vec3::Constant(1e9);
  Vec3 upper = Vec3::Constant(-1e9);
  for (const auto& v : small.vertices) {
    lower = lower.cwiseMin(Vec3(v[0], v[1], v[2]));
    upper = upper.cwiseMax(Vec3(v[0], v[1], v[2]));
  }
  const double within = 0.05 * torus.value().size();
  EXPECT_LT((lower - torus.value().lower()).norm(), within);
  EXPECT_LT((upper - torus.value().upper()).norm(), within);
}

}  // namespace
}  // namespace odds::report
