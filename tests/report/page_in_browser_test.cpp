// Opens the page in a real browser, where there is one, and asks it what it drew.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "odds/report/run_report.hpp"
#include "report/made_recording.hpp"

namespace odds::report {
namespace {

namespace fs = std::filesystem;

/// The page as the browser sees it after its scripts ran; empty without a browser.
std::string rendered(const fs::path& page, const fs::path& profile) {
  const std::string command =
      "timeout 60 chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
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

  std::string open(const MadeRecording& made) {
    const auto files = write_run_report(directory_, made.info, summarize(made.info, made.ticks), made.ticks);
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
  EXPECT_EQ(root_number(dom, "data-charts"), 10);
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

}  // namespace
}  // namespace odds::report
