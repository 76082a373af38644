// How far a query's end lies beyond its budget, whatever meets: surfaces that touch, and bodies that lie in each other.
// A machine that takes a query's processor away for less than a microsecond or two is not seen by its ledger of stalls.
// Several passes over the same poses tell: what is late in each of them is so by itself.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "benchmark/mesh_argument.hpp"
#include "benchmark/peer_times.hpp"
#include "odds/math/random.hpp"
#include "odds/query/pair.hpp"
#include "odds/volume/kind.hpp"
#include "support/cache_emptier.hpp"

namespace odds::benchmark {
namespace {

/// Where B is, query after query.
struct Course {
  const char* name;
  double place;  ///< of B's mean place along x, in sizes of the mesh
  bool jumps;    ///< to another place and rotation each time; else it drifts by 3e-5 of the size
};
constexpr Course courses[] = {
    {"in itself, drifting", 0.0, false}, {"overlapping, drifting", 0.15, false}, {"overlapping, jumping", 0.15, true},
    {"touching, drifting", 0.5, false},  {"touching, jumping", 0.45, true},
};

struct Settings {
  std::vector<std::string> meshes{"made:torus_knot", "made:bumpy_sphere"};
  std::vector<double> budgets_us{1, 2, 5, 10, 20, 50, 100};
  std::vector<int> contacts{1, 4};
  std::vector<std::string> volumes{"wide"};
  std::string only;
  std::size_t count = 10000;
  std::size_t passes = 1;     ///< over the same poses
  std::uint64_t seed = 7;     ///< of the poses
  long wait_us = 0;           ///< between two queries
  bool empty_caches = false;  ///< between two queries
  bool late = false;          ///< contacts are made over several queries
  bool quality = false;       ///< also how far contacts point from where those of a query without a budget do
};

/// Cases are courses with a number of contacts and a budget.
struct Tally {
  std::size_t cases = 0;
  std::size_t half_us_at_p99 = 0;
  std::size_t one_us_at_p999 = 0;
  std::size_t half_us_each_time = 0;  ///< at p99, of what every pass takes at least
  std::size_t one_us_each_time = 0;   ///< at p99.9

  /// Microseconds beyond the budget, net of stalls: of one pass, and what each takes at least.
  void add(const std::vector<double>& of_one, const std::vector<double>& of_each) {
    ++cases;
    half_us_at_p99 += quantile(of_one, 0.99) <= 0.5 ? 1U : 0U;
    one_us_at_p999 += quantile(of_one, 0.999) <= 1.0 ? 1U : 0U;
    half_us_each_time += quantile(of_each, 0.99) <= 0.5 ? 1U : 0U;
    one_us_each_time += quantile(of_each, 0.999) <= 1.0 ? 1U : 0U;
  }
  void add(const Tally& other) noexcept {
    cases += other.cases;
    half_us_at_p99 += other.half_us_at_p99;
    one_us_at_p999 += other.one_us_at_p999;
    half_us_each_time += other.half_us_each_time;
    one_us_each_time += other.one_us_each_time;
  }
  void print(const std::string& of, std::size_t passes) const {
    std::printf("  %s: p99 <= 0.5 us in %zu of %zu cases, p99.9 <= 1 us in %zu\n", of.c_str(), half_us_at_p99, cases,
                one_us_at_p999);
    if (passes == 1) return;
    std::printf("  %s, what is late in each of %zu passes: p99 <= 0.5 us in %zu of %zu cases, p99.9 <= 1 us in %zu\n",
                of.c_str(), passes, half_us_each_time, cases, one_us_each_time);
  }
};

class Poses {
 public:
  Poses(const Course& course, double size, std::uint64_t seed) : course_(course), size_(size), random_(seed) {
    pose_.translation = course.place * size * Vec3::UnitX();
    if (course.place > 0.0) pose_.rotation = random_.rotation().toRotationMatrix();
  }
  math::Pose next() {
    if (course_.jumps) {
      return math::Pose::from_quaternion(course_.place * random_.uniform(0.3, 1.1) * size_ * random_.direction(),
                                         random_.rotation());
    }
    constexpr double step = 3e-5;
    if (++steps_ % 2000 == 0) direction_ = random_.direction();
    pose_.translation += step * size_ * direction_;
    pose_.rotation = Eigen::AngleAxisd(step, direction_).toRotationMatrix() * pose_.rotation;
    // Back to where the course is, without a jump.
    pose_.translation += 1e-3 * (course_.place * size_ * Vec3::UnitX() - pose_.translation);
    Eigen::Quaterniond q(pose_.rotation);
    pose_.rotation = q.normalized().toRotationMatrix();
    return pose_;
  }

 private:
  const Course& course_;
  double size_;
  math::Random random_;
  math::Pose pose_;
  Vec3 direction_ = Vec3(1.0, 2.0, 3.0).normalized();
  int steps_ = 0;
};

/// Degrees between the means of both answers' normals, weighted by depth.
double angle_between(const query::Answer& one, const query::Answer& other) {
  const auto push = [](const query::Answer& answer) {
    Vec3 sum = Vec3::Zero();
    for (const query::Contact& contact : answer.contacts) sum += (contact.depth + 1e-12) * contact.normal;
    return Vec3(sum.stableNormalized());
  };
  return std::acos(std::clamp(push(one).dot(push(other)), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// The least of what each pose's query took beyond the budget in all passes; `net_us`: of the first.
std::vector<double> least_of_each(query::Pair& pair, const Course& course, const query::Request& request,
                                  std::vector<double> net_us, const Settings& settings) {
  testing::CacheEmptier emptier;
  for (std::size_t pass = 1; pass < settings.passes; ++pass) {
    pair.reset();
    Poses poses(course, pair.a().mesh().size(), settings.seed);
    for (double& least : net_us) {
      const math::Pose pose = poses.next();
      if (settings.wait_us > 0) std::this_thread::sleep_for(std::chrono::microseconds(settings.wait_us));
      if (settings.empty_caches) emptier.run();
      least = std::min(least, pair.run(pose, request).cost.net_overshoot_us);
    }
  }
  return net_us;
}

void measure(const query::Shape& shape, query::Pair& pair, query::Pair* reference, const Course& course, int contacts,
             double budget_us, const Settings& settings, Tally& tally) {
  const std::size_t count = settings.count;
  pair.reset();
  if (reference != nullptr) reference->reset();
  std::vector<double> angles;
  Poses poses(course, shape.mesh().size(), settings.seed);
  std::vector<double> net_us;
  std::vector<double> gross_us;
  std::vector<double> own_us;   // the query's own time, gross less stalls, beyond the budget
  std::vector<double> calm_us;  // of queries without a stall: after one, caches are cold
  std::size_t hits = 0;
  std::size_t whole = 0;
  std::size_t late = 0;
  double made_of = 0.0;
  std::vector<double> unused_us;  // by answers that were told to end
  testing::CacheEmptier emptier;
  const query::Request request{.budget = query::Budget::time(budget_us), .max_contacts = contacts};
  for (std::size_t i = 0; i < count; ++i) {
    const math::Pose pose = poses.next();
    if (settings.wait_us > 0) std::this_thread::sleep_for(std::chrono::microseconds(settings.wait_us));
    if (settings.empty_caches) emptier.run();
    const query::Answer& answer = pair.run(pose, request);
    net_us.push_back(answer.cost.net_overshoot_us);
    gross_us.push_back(answer.cost.overshoot_us);
    own_us.push_back(std::max(0.0, answer.cost.net_us() - budget_us));
    if (!(answer.cost.stall_us > 0.0)) calm_us.push_back(answer.cost.net_overshoot_us);
    if (answer.contacts.empty()) continue;
    ++hits;
    whole += answer.contacts_complete ? 1U : 0U;
    late += answer.contacts_late ? 1U : 0U;
    if (!answer.contacts_complete) unused_us.push_back(std::max(0.0, budget_us - answer.cost.net_us()));
    if (reference != nullptr) {
      angles.push_back(angle_between(answer, reference->run(pose, {.max_contacts = contacts})));
    }
    made_of += static_cast<double>(answer.contact_pairs);
  }
  const std::vector<double> each_us = least_of_each(pair, course, request, net_us, settings);
  tally.add(net_us, each_us);
  const double p99 = quantile(net_us, 0.99);
  const double p999 = quantile(net_us, 0.999);
  const auto n = static_cast<double>(count);
  std::printf("  %-22s %8d %8g %8.2f %8.2f %8.2f %8.2f %9.2f %9.2f %8zu %8.2f %8.2f %8.1f %8.1f %8.1f %8.1f %8.1f\n",
              course.name, contacts, budget_us, quantile(net_us, 0.5), p99, p999, quantile(net_us, 1.0),
              quantile(gross_us, 0.999), quantile(own_us, 0.999), count - calm_us.size(), quantile(calm_us, 0.99),
              quantile(calm_us, 0.999), 100.0 * static_cast<double>(hits) / n,
              100.0 * static_cast<double>(whole) / std::max(1.0, static_cast<double>(hits)),
              100.0 * static_cast<double>(late) / std::max(1.0, static_cast<double>(hits)),
              made_of / std::max(1.0, static_cast<double>(hits)), quantile(unused_us, 0.5));
  if (settings.passes > 1) {
    std::printf("  %22s in each of %zu passes: p99 %.2f, p99.9 %.2f\n", "", settings.passes, quantile(each_us, 0.99),
                quantile(each_us, 0.999));
  }
  if (reference != nullptr) {
    std::printf("  %22s degrees off: median %.1f, p90 %.1f\n", "", quantile(angles, 0.5), quantile(angles, 0.9));
  }
  std::fflush(stdout);
}

bool measure_all(const std::string& name, const std::shared_ptr<const mesh::TriangleMesh>& mesh,
                 const std::string& volume, const Settings& settings, Tally& total) {
  const auto built = query::Shape::build(mesh, {.volume = volume::kind_from_name(volume).value()});
  if (!built) {
    std::fprintf(stderr, "%s\n", built.error().message().c_str());
    return false;
  }
  const std::shared_ptr<const query::Shape>& shape = built.value();
  auto pair = std::move(query::Pair::make(shape, shape, {.late_contacts = settings.late})).value();
  auto reference = std::move(query::Pair::make(shape, shape)).value();
  std::printf(
      "%s, %s, %zu triangles, with its own copy; %zu queries each; microseconds beyond the budget, net of stalls\n",
      name.c_str(), volume.c_str(), shape->mesh().triangles().size(), settings.count);
  std::printf("  %-22s %8s %8s %8s %8s %8s %8s %9s %9s %8s %8s %8s %8s %8s %8s %8s %8s\n", "", "contacts", "budget",
              "p50", "p99", "p99.9", "longest", "gr. p99.9", "own p99.9", "stalled", "cm. p99", "cm.p99.9", "hits %",
              "whole %", "late %", "made of", "unused");
  Tally tally;
  for (const Course& course : courses) {
    if (std::string(course.name).find(settings.only) == std::string::npos) continue;
    for (const int contacts : settings.contacts) {
      for (const double budget_us : settings.budgets_us) {
        measure(*shape, pair, settings.quality ? &reference : nullptr, course, contacts, budget_us, settings, tally);
      }
    }
  }
  tally.print(name + ", " + volume, settings.passes);
  total.add(tally);
  return true;
}

int run(const Settings& settings) {
  Tally total;
  for (const std::string& name : settings.meshes) {
    const auto mesh = mesh_of(name);
    if (!mesh) {
      std::fprintf(stderr, "%s\n", mesh.error().message().c_str());
      return 1;
    }
    for (const std::string& volume : settings.volumes) {
      if (!measure_all(name, mesh.value(), volume, settings, total)) return 1;
    }
  }
  total.print("all", settings.passes);
  return 0;
}

}  // namespace
}  // namespace odds::benchmark

int main(int argc, char** argv) {
  CLI::App app{"How far queries with contacts end beyond their budget, of meshes with their own copies"};
  odds::benchmark::Settings settings;
  app.add_option("meshes", settings.meshes, "files, or made ones")->capture_default_str();
  app.add_option("--budgets-us", settings.budgets_us, "microseconds")->delimiter(',')->check(CLI::PositiveNumber);
  app.add_option("--contacts", settings.contacts, "most contacts a query")->delimiter(',')->check(CLI::Range(0, 8));
  app.add_option("--bv", settings.volumes, "bounding volumes")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(odds::volume::kind_words.begin(), odds::volume::kind_words.end())))
      ->capture_default_str();
  app.add_option("--only", settings.only, "courses whose name has this in it");
  app.add_option("--count", settings.count, "queries each")
      ->check(CLI::Range(std::size_t{1000}, std::size_t{10000000}));
  app.add_option("--passes", settings.passes, "over the same poses: tells what is late in each")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "of the poses")->capture_default_str();
  app.add_option("--wait-us", settings.wait_us, "microseconds between two queries, in which caches grow cold")
      ->check(CLI::Range(0L, 1000000L));
  app.add_flag("--empty-caches", settings.empty_caches,
               "fill a core's own caches with something else between two queries");
  app.add_flag("--late", settings.late, "contacts may be made over several queries (Request::late_contacts)");
  app.add_flag("--quality", settings.quality, "also how far contacts point from those of a query without a budget");
  CLI11_PARSE(app, argc, argv);
  return odds::benchmark::run(settings);
}
