// The host block against made-up machines, and once on this one.
#include "odds/realtime/host.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <clocale>
#include <filesystem>
#include <fstream>
#include <thread>

namespace odds::realtime {
namespace {

namespace fs = std::filesystem;

class MadeUpHost : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() / ("odds_host_" + std::to_string(::getpid()));
    fs::remove_all(root_);
  }
  void TearDown() override { fs::remove_all(root_); }

  void put(const std::string& path, const std::string& text) const {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text << "\n";
  }
  [[nodiscard]] HostLine line(const std::string& wanted) const {
    for (const HostLine& candidate : describe_host(root_.string())) {
      if (candidate.name == wanted) return candidate;
    }
    ADD_FAILURE() << "no line " << wanted;
    return {};
  }

  fs::path root_;
};

TEST_F(MadeUpHost, with_no_files_at_all_is_described_as_unknown) {
  EXPECT_EQ(line("processor").readiness, HostLine::Readiness::unknown);
  EXPECT_EQ(line("kernel").value, "unknown");
  EXPECT_EQ(line("kernel pre-emption").readiness, HostLine::Readiness::unknown);
}

TEST_F(MadeUpHost, real_time_kernel_and_held_frequency_are_good) {
  put("proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian 6.1.1-1");
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
  EXPECT_EQ(line("kernel pre-emption").value, "PREEMPT_RT");
  EXPECT_EQ(line("kernel pre-emption").readiness, HostLine::Readiness::good);
  EXPECT_EQ(line("frequency governor").readiness, HostLine::Readiness::good);
}

TEST_F(MadeUpHost, ordinary_kernel_and_saving_governor_hinder_and_say_what_helps) {
  put("proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian 6.1.1-1");
  put("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  EXPECT_EQ(line("kernel pre-emption").value, "PREEMPT_DYNAMIC");
  EXPECT_EQ(line("kernel pre-emption").readiness, HostLine::Readiness::hinders);
  EXPECT_NE(line("frequency governor").remark.find("cpupower"), std::string::npos);
}

TEST_F(MadeUpHost, a_load_just_beyond_the_processors_hinders_in_every_locale) {
  put("proc/loadavg", std::to_string(std::max(1U, std::thread::hardware_concurrency())) + ".50 0.10 0.10 1/100 1234");
  EXPECT_EQ(line("load (1, 5, 15 min)").readiness, HostLine::Readiness::hinders);
  if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr) GTEST_SKIP() << "no locale with decimal commas";
  const HostLine::Readiness with_commas = line("load (1, 5, 15 min)").readiness;
  std::setlocale(LC_NUMERIC, "C");
  EXPECT_EQ(with_commas, HostLine::Readiness::hinders);
}

TEST_F(MadeUpHost, a_quota_anywhere_above_the_own_group_counts) {
  put("proc/self/cgroup", "0::/system.slice/loop.service");
  put("sys/fs/cgroup/system.slice/loop.service/cpu.max", "max 100000");
  put("sys/fs/cgroup/system.slice/cpu.max", "150000 100000");
  EXPECT_EQ(line("control-group quota").value, "1.50 processors");
  EXPECT_EQ(line("control-group quota").readiness, HostLine::Readiness::hinders);
}

TEST_F(MadeUpHost, no_quota_is_good) {
  put("proc/self/cgroup", "0::/");
  put("sys/fs/cgroup/cpu.max", "max 100000");
  EXPECT_EQ(line("control-group quota").value, "none");
}

TEST_F(MadeUpHost, guests_are_recognised_by_the_processor_flag) {
  put("proc/cpuinfo", "model name\t: Some CPU\nflags\t\t: fpu vme hypervisor lahf_lm");
  put("sys/class/dmi/id/sys_vendor", "QEMU");
  EXPECT_EQ(line("processor").value, "Some CPU");
  EXPECT_EQ(line("virtualised").value, "virtual machine (QEMU)");
  put("proc/cpuinfo", "model name\t: Some CPU\nflags\t\t: fpu vme hypervisorless lahf_lm");
  EXPECT_EQ(line("virtualised").readiness, HostLine::Readiness::good);
}

TEST(Host, this_machine_is_described_without_empty_values) {
  for (const HostLine& line : describe_host()) {
    EXPECT_FALSE(line.name.empty());
    EXPECT_FALSE(line.value.empty()) << line.name;
    EXPECT_TRUE(line.readiness != HostLine::Readiness::hinders || !line.remark.empty()) << line.name;
  }
}

}  // namespace
}  // namespace odds::realtime
