// What contacts cost over the verdict alone: bodies at rest on each other, the usual and the hardest case of a patch.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/peer_times.hpp"
#include "odds/math/random.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/query/pair.hpp"

namespace odds::benchmark {
namespace {

struct Rest {
  const char* name;
  const char* mesh;    ///< of both bodies
  Vec3 place;          ///< of B, metres
  double turned;       ///< about z, radians
  double trembling_m;  ///< of the place, from pose to pose
};
constexpr double brick_height = 0.065;
const Rest rests[] = {
    {"bricks of 12", "made:box:x=0.2,y=0.1,z=0.065,cells=1", {1e-3, 2e-3, 5e-5 - brick_height}, 1e-4, 1e-3},
    {"bricks of 768", "made:box:x=0.2,y=0.1,z=0.065,cells=8", {1e-3, 2e-3, 5e-5 - brick_height}, 1e-4, 1e-3},
    {"768, askew", "made:box:x=0.2,y=0.1,z=0.065,cells=8", {0.03, 0.02, 5e-5 - brick_height}, 0.4, 1e-3},
    {"bricks of 1452", "made:box:x=0.2,y=0.1,z=0.065,cells=11", {1e-3, 2e-3, 5e-5 - brick_height}, 1e-4, 1e-3},
    {"tori, deep", "made:torus", {0.2, 0.0, 0.0}, 1.5, 1e-3},
};

std::vector<math::Pose> poses_of(const Rest& rest, std::size_t count) {
  math::Random random(1);
  const auto either = [&random] { return 2.0 * random.uniform() - 1.0; };
  std::vector<math::Pose> poses(count);
  for (math::Pose& pose : poses) {
    const Vec3 axis = Vec3(0.1 * either(), 0.1 * either(), 1.0).normalized();
    pose.rotation = Eigen::AngleAxisd(rest.turned * (1.0 + 0.1 * either()), axis).toRotationMatrix();
    pose.translation = rest.place + rest.trembling_m * Vec3(either(), either(), 0.01 * either());
  }
  return poses;
}

int run(const std::string& only, std::size_t count, double budget_us) {
  std::printf("%-16s %9s %9s %9s %9s %9s %9s\n", "at rest", "verdict", "contacts", "p90", "p99", "whole, %", "number");
  for (const Rest& rest : rests) {
    if (std::string(rest.name).find(only) == std::string::npos) continue;
    auto made = mesh::made::make_shape(rest.mesh);
    const auto shape = query::Shape::build(std::make_shared<const mesh::TriangleMesh>(std::move(made).value()));
    auto pair = std::move(query::Pair::make(shape.value(), shape.value())).value();
    std::vector<double> verdict_us;
    std::vector<double> contacts_us;
    std::size_t whole = 0;
    std::size_t contacts = 0;
    for (const math::Pose& pose : poses_of(rest, count)) {
      query::Request request{.max_contacts = 0};
      const double start = clock_us(CLOCK_THREAD_CPUTIME_ID);
      if (pair.run(pose, request).verdict != query::Verdict::hit) continue;
      const double between = clock_us(CLOCK_THREAD_CPUTIME_ID);
      request.max_contacts = 4;
      request.budget.microseconds = budget_us;
      const query::Answer& answer = pair.run(pose, request);
      contacts_us.push_back(clock_us(CLOCK_THREAD_CPUTIME_ID) - between);
      verdict_us.push_back(between - start);
      whole += answer.contacts_complete ? 1U : 0U;
      contacts += answer.contacts.size();
    }
    if (contacts_us.empty()) continue;
    const auto found = static_cast<double>(contacts_us.size());
    std::printf("%-16s %9.1f %9.1f %9.1f %9.1f %9.1f %9.2f\n", rest.name, quantile(verdict_us, 0.5),
                quantile(contacts_us, 0.5), quantile(contacts_us, 0.9), quantile(contacts_us, 0.99),
                100.0 * static_cast<double>(whole) / found, static_cast<double>(contacts) / found);
  }
  return 0;
}

}  // namespace
}  // namespace odds::benchmark

int main(int argc, char** argv) {
  CLI::App app{
      "Microseconds of this thread for the verdict, and for up to four contacts, of bodies that rest on each other"};
  std::string only;
  std::size_t count = 2000;
  double budget_us = std::numeric_limits<double>::infinity();
  app.add_option("--only", only, "those whose name has this in it");
  app.add_option("--poses", count, "poses of each")->check(CLI::Range(std::size_t{10}, std::size_t{10000000}));
  app.add_option("--budget-us", budget_us, "of the query with contacts; else unlimited")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  return odds::benchmark::run(only, count, budget_us);
}
