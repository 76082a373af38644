// The replay of the report page under a person's hands: play, pause, scrub, turn, layers. In a real browser, where
// there is one.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>

#include "odds/mesh/made/by_name.hpp"
#include "odds/report/run_report.hpp"
#include "report/browser.hpp"
#include "report/made_recording.hpp"
#include "support/temporary_folder.hpp"

namespace odds::report {
namespace {

ReplayMesh replay_mesh(const std::string& shape) {
  const auto made = std::make_shared<const mesh::TriangleMesh>(mesh::made::make_shape(shape).value());
  ReplayMesh mesh = simplified(*made, 20'000);
  mesh.boxes = query::upper_boxes(*query::Shape::build(made).value(), 100);
  return mesh;
}

/// A ball over a plate that goes up and down once; it touches in the lower half, and a guess is added there. It plays
/// for forty seconds, so that a busy machine does not come to its end between two clicks.
RunReplay bouncing() {
  RunReplay replay;
  replay.meshes = {replay_mesh("made:icosphere:radius=0.02"), replay_mesh("made:box:x=0.2,y=0.2,z=0.02,cells=8")};
  replay.bodies = {{"plate", 1, false, false, {}}, {"tool", 0, true, true, {}}};
  for (std::uint64_t tick = 0; tick < 40000; tick += 200) {
    math::Pose pose;
    pose.translation.z() = 0.035 + 0.01 * std::cos(0.0001570796 * static_cast<double>(tick));
    ReplayFrame frame{tick, {pose}, {}};
    if (pose.translation.z() < 0.03) {
      frame.marks.push_back({Vec3(0.0, 0.0, 0.01), Vec3::UnitZ(), 0.03 - pose.translation.z(), 1.0, false});
      frame.marks.push_back({Vec3(0.01, 0.0, 0.01), Vec3::UnitZ(), 0.0, 0.4, true});
    }
    replay.frames.push_back(std::move(frame));
  }
  return replay;
}

class ReplayClicks : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!pages_have_replay()) GTEST_SKIP() << "built without a library for three dimensions";
    if (!Browser::is_installed()) GTEST_SKIP() << "chromium is not installed";
    std::signal(SIGPIPE, SIG_IGN);
    const MadeRecording made = made_recording(2.0);
    const RunReplay replay = bouncing();
    const auto files =
        write_run_report(folder_.path() / "run", made.info, summarize(made.info, made.ticks), made.ticks, &replay);
    ASSERT_TRUE(files.ok()) << files.error().message();
    browser_.emplace(folder_.path() / "profile");
    browser_->open("file://" + std::filesystem::absolute(files.value().page).string());
    ASSERT_TRUE(browser_->evaluate("document.documentElement.dataset.error === undefined").get<bool>());
  }
  int frame() { return browser_->evaluate("Number(document.getElementById('replay-time').value)"); }
  std::string label() { return browser_->evaluate("document.getElementById('replay-play').textContent"); }
  int root_number(const std::string& name) {
    return browser_->evaluate("Number(document.documentElement.dataset." + name + ")");
  }
  void next_pictures(int count) {
    browser_->evaluate("new Promise((done) => { let n = " + std::to_string(count) +
                       "; const step = () => --n < 0 ? done(0) : requestAnimationFrame(step); step(); })");
  }
  void scrub(double share) { browser_->click("replay-time", share); }
  /// How many different colours a picture has; asked in a page without our content security policy.
  static int colours(Browser& other, const std::string& png) {
    return other.evaluate("(async () => { const image = new Image(); image.src = 'data:image/png;base64," + png +
                          "'; await image.decode(); const c = document.createElement('canvas'); c.width = image.width;"
                          "c.height = image.height; const d = c.getContext('2d'); d.drawImage(image, 0, 0);"
                          "const p = new Uint32Array(d.getImageData(0, 0, c.width, c.height).data.buffer);"
                          "return new Set(p).size; })()");
  }

  testing::TemporaryFolder folder_;
  std::optional<Browser> browser_;
};

TEST_F(ReplayClicks, PlaysPausesAndComesToItsEnd) {
  scrub(0.02);
  const int begin = frame();
  EXPECT_LT(begin, 20);
  EXPECT_EQ(label(), "Play");
  browser_->click("replay-play");
  EXPECT_EQ(label(), "Pause");
  browser_->evaluate("new Promise((done) => { const step = () => document.getElementById('replay-time').value > " +
                     std::to_string(begin + 3) + " ? done(0) : requestAnimationFrame(step); step(); })");
  browser_->click("replay-play");
  EXPECT_EQ(label(), "Play");
  const int paused = frame();
  EXPECT_GT(paused, begin + 3);
  next_pictures(10);
  EXPECT_EQ(frame(), paused);
  scrub(0.97);
  browser_->click("replay-play");
  browser_->evaluate(
      "new Promise((done) => { const step = () => document.getElementById('replay-play').textContent === "
      "'Play' ? done(0) : requestAnimationFrame(step); step(); })");
  EXPECT_EQ(frame(), 199);
}

TEST_F(ReplayClicks, ScrubsToTheTimeUnderTheMouseAndStepsByKeys) {
  scrub(0.25);
  const int quarter = frame();
  EXPECT_NEAR(quarter, 50, 8);
  const std::string text = browser_->evaluate("document.getElementById('replay-text').textContent");
  EXPECT_NEAR(std::stod(text), 0.2 * quarter, 0.006) << text;
  browser_->click("replay-view");
  browser_->key("ArrowRight");
  EXPECT_EQ(frame(), quarter + 1);
  browser_->key("ArrowLeft");
  browser_->key("ArrowLeft");
  EXPECT_EQ(frame(), quarter - 1);
  browser_->key(" ", " ");
  EXPECT_EQ(label(), "Pause");
  browser_->key(" ", " ");
  EXPECT_EQ(label(), "Play");
}

TEST_F(ReplayClicks, ShowsContactsCellPairsAndTheFront) {
  scrub(0.5);  // the ball is in the plate
  EXPECT_EQ(root_number("replayMarks"), 2);
  EXPECT_EQ(root_number("replayFront"), 0);
  browser_->click("replay-front");
  const int touching = root_number("replayFront");
  EXPECT_GT(touching, 1);
  browser_->click("replay-marks");
  EXPECT_EQ(root_number("replayMarks"), 0);
  browser_->click("replay-marks");
  scrub(0.01);  // and here 15 mm over it
  EXPECT_EQ(root_number("replayMarks"), 0);
  EXPECT_EQ(root_number("replayFront"), 0);
}

TEST_F(ReplayClicks, DrawsAPictureThatTurnsWithTheMouse) {
  scrub(0.5);
  const std::string before = browser_->screenshot("replay-view");
  browser_->drag("replay-view", 120.0, 30.0);
  const std::string after = browser_->screenshot("replay-view");
  EXPECT_NE(before, after);
  Browser other(folder_.path() / "other");
  EXPECT_GT(colours(other, before), 20);  // a blank one has one
  EXPECT_GT(colours(other, after), 20);
}

}  // namespace
}  // namespace odds::report
