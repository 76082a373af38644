// odds_bench_peers: this library and other engines on the same poses, in one process, one call of each in turn.
#include <sched.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "benchmark/peer_fcl.hpp"
#include "benchmark/peer_odds.hpp"
#include "benchmark/peer_ode.hpp"
#include "benchmark/peer_times.hpp"
#include "benchmark/peer_workload.hpp"
#include "benchmark/pose_class.hpp"
#include "benchmark/stopwatch.hpp"
#include "odds/query/shape.hpp"
#include "support/value_or_throw.hpp"
#ifdef ODDS_WITH_BULLET
#include "benchmark/peer_bullet.hpp"
#endif

namespace odds::benchmark {
namespace {

using testing::value_or_throw;

struct Settings {
  std::vector<std::string> meshes;
  std::vector<std::pair<std::string, std::string>> pairs;
  std::vector<std::string> nested;
  std::vector<std::string> volumes = {std::string(volume::name(query::ShapeOptions{}.volume))};
  std::vector<std::string> methods;
  std::vector<std::string> peers = {"fcl", "ode", "bullet"};
  std::vector<std::string> classes;
  std::size_t poses = 200;
  std::size_t steps = 2000;
  double step = 3e-5;  // of A's size
  std::size_t repeat = 5;
  int builds = 3;
  int ode_contacts = 32;
  int core = -1;
  std::uint64_t seed = 1;
  bool all = false;
  bool trajectory = false;
  bool cpu_time = false;
  bool untested_leaves = false;
  std::vector<double> budgets_us;
  std::string csv;
};

using Peers = std::vector<std::unique_ptr<Peer>>;

query::Method method_of(const std::string& name) {
  if (name == "exact") return query::Method::exact;
  return name == "incremental" ? query::Method::incremental : query::Method::time_critical;
}

Peers make_peers(const Settings& settings, const MeshPair& meshes) {
  Peers peers;
  for (const std::string& word : settings.volumes) {
    for (const std::string& method : settings.methods) {
      const volume::Kind kind = volume::kind_from_name(word).value();
      OddsSettings ours{.volume = kind, .method = method_of(method)};
      peers.push_back(make_odds_peer(meshes, ours, settings.builds));
      for (const double budget_us : settings.budgets_us) {
        OddsSettings limited = ours;
        limited.budget_us = budget_us;
        peers.push_back(make_odds_peer(meshes, limited, settings.builds));
      }
      if (!settings.untested_leaves || kind == volume::Kind::wide) continue;
      ours.leaf_test = false;
      peers.push_back(make_odds_peer(meshes, ours, settings.builds));
    }
  }
  for (const std::string& peer : settings.peers) {
    if (peer == "fcl") peers.push_back(make_fcl_peer(meshes, settings.builds));
    if (peer == "ode") peers.push_back(make_ode_peer(meshes, settings.ode_contacts, settings.builds));
#ifdef ODDS_WITH_BULLET
    if (peer == "bullet") peers.push_back(make_bullet_peer(meshes, settings.builds));
#endif
  }
  return peers;
}

// Builds may use all cores, queries one.
class PinnedToOneCore {
 public:
  explicit PinnedToOneCore(int core) {
    sched_getaffinity(0, sizeof before_, &before_);
    if (core < 0) core = sched_getcpu();
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(static_cast<std::size_t>(core), &one);
    if (sched_setaffinity(0, sizeof one, &one) != 0) {
      throw std::runtime_error("core " + std::to_string(core) + " cannot be used; choose another by --core");
    }
  }
  ~PinnedToOneCore() { sched_setaffinity(0, sizeof before_, &before_); }
  PinnedToOneCore(const PinnedToOneCore&) = delete;
  PinnedToOneCore& operator=(const PinnedToOneCore&) = delete;

 private:
  cpu_set_t before_{};
};

// Whether FCL says the same with B shifted a little to all sides: then rounding does not decide.
bool is_robust(Peer& fcl, const math::Pose& pose, double shift, bool verdict) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      math::Pose shifted = pose;
      shifted.translation[axis] += sign * shift;
      if (fcl.collide(shifted) != verdict) return false;
    }
  }
  return true;
}

std::size_t count_wrong(const PeerRun& run, Peer& fcl, const std::vector<math::Pose>& poses,
                        const std::vector<char>& truth, double shift) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool hit = run.contacts[i] != 0;
    if (hit != (truth[i] != 0) && is_robust(fcl, poses[i], shift, truth[i] != 0)) ++wrong;
  }
  return wrong;
}

// The engines take turns, so that what else the machine does meets all of them; the median of the repetitions counts.
// Along a trajectory a repetition is the whole of it, else it is one pose.
std::vector<PeerRun> run_peers(const Settings& settings, const Peers& peers, const std::vector<math::Pose>& poses) {
  std::vector<PeerRun> runs(peers.size());
  std::vector<std::vector<std::vector<double>>> times(peers.size(), std::vector<std::vector<double>>(poses.size()));
  const Stopwatch watch(settings.cpu_time);
  const auto visit = [&](std::size_t i, std::size_t turn) {
    for (std::size_t k = 0; k < peers.size(); ++k) {
      const std::size_t e = (k + turn) % peers.size();
      if (!settings.trajectory || !peers[e]->is_coherent()) peers[e]->forget();
      times[e][i].push_back(watch.time(*peers[e], poses[i], settings.all, runs[e].contacts[i]));
    }
  };
  for (std::size_t e = 0; e < peers.size(); ++e) {
    runs[e].engine = peers[e]->name();
    runs[e].contacts.resize(poses.size());
  }
  if (settings.trajectory) {
    for (std::size_t pass = 0; pass < settings.repeat; ++pass) {
      for (const auto& peer : peers) peer->forget();
      for (std::size_t i = 0; i < poses.size(); ++i) visit(i, pass);
    }
  } else {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t pass = 0; pass < settings.repeat; ++pass) visit(i, pass);
    }
  }
  for (std::size_t e = 0; e < peers.size(); ++e) {
    for (auto& of_pose : times[e]) runs[e].microseconds.push_back(quantile(std::move(of_pose), 0.5));
  }
  return runs;
}

void write_csv(std::ofstream& csv, const std::string& mesh, PoseClass pose_class, const std::vector<PeerRun>& runs,
               const std::vector<char>& truth) {
  if (!csv.is_open()) return;
  for (const PeerRun& run : runs) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
      csv << '"' << mesh << "\"," << name(pose_class) << ',' << i << ',' << run.engine << ',' << run.microseconds[i]
          << ',' << run.contacts[i] << ',' << int{truth[i]} << '\n';
    }
  }
}

void compare(const Settings& settings, const Workload& workload, Ratios& ratios, std::ofstream& csv) {
  std::printf("\n== %s: %zu + %zu triangles\n", workload.name.c_str(), workload.meshes.a->triangles().size(),
              workload.meshes.b->triangles().size());
  const Peers peers = make_peers(settings, workload.meshes);
  print_footprints(peers);
  const auto fcl = make_fcl_peer(workload.meshes, 1);  // the judge, in the race or not
  const PinnedToOneCore pinned(settings.core);
  const auto collides = [&](const math::Pose& pose) { return peers.front()->collide(pose); };
  const double size = workload.meshes.a->size();
  for (const std::string& word : settings.classes) {
    const auto at = std::find(pose_class_names.begin(), pose_class_names.end(), word);
    const auto pose_class = static_cast<PoseClass>(at - pose_class_names.begin());
    if ((pose_class == PoseClass::nested) != workload.nested) continue;
    const std::vector<math::Pose> poses =
        settings.trajectory ? make_trajectory(workload.meshes, pose_class, settings.steps, settings.step * size,
                                              settings.seed, collides)
                            : make_poses(workload.meshes, pose_class, settings.poses, settings.seed, collides);
    std::vector<char> truth;
    for (const math::Pose& pose : poses) truth.push_back(fcl->collide(pose) ? 1 : 0);
    std::vector<PeerRun> runs = run_peers(settings, peers, poses);
    for (PeerRun& run : runs) run.wrong = count_wrong(run, *fcl, poses, truth, 1e-9 * size);
    std::printf(" %s: %zu poses, %td hits\n", word.c_str(), poses.size(), std::count(truth.begin(), truth.end(), 1));
    print_runs(runs);
    std::fflush(stdout);
    ratios.add(word, runs);
    write_csv(csv, workload.name, pose_class, runs, truth);
  }
}

std::vector<Workload> load_workloads(const Settings& settings) {
  if (settings.meshes.empty() && settings.pairs.empty() && settings.nested.empty()) {
    return value_or_throw(default_workloads());
  }
  std::vector<Workload> workloads;
  for (const std::string& mesh : settings.meshes) workloads.push_back(value_or_throw(two_copies(mesh)));
  for (const auto& [a, b] : settings.pairs) workloads.push_back(value_or_throw(unlike_pair(a, b)));
  for (const std::string& mesh : settings.nested) workloads.push_back(value_or_throw(nested_copies(mesh)));
  return workloads;
}

void add_options(CLI::App& app, Settings& settings) {
  app.add_option("MESH", settings.meshes, "two copies of each: file or made:NAME:key=value (none: a set of its own)");
  app.add_option("--pair", settings.pairs, "two unlike meshes A B")->type_name("A B");
  app.add_option("--nested", settings.nested, "a mesh around its copy scaled by 0.994");
  app.add_option("--bv", settings.volumes, "bounding volumes of ours, the first is compared with")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(volume::kind_words.begin(), volume::kind_words.end())))
      ->capture_default_str();
  app.add_option("--methods", settings.methods, "of ours: exact, incremental, time-critical (exact)")
      ->delimiter(',')
      ->check(CLI::IsMember({"exact", "incremental", "time-critical"}));
  app.add_option("--peers", settings.peers, "other engines: fcl, ode, bullet; or none")
      ->delimiter(',')
      ->check(CLI::IsMember({"fcl", "ode", "bullet", "none"}))
      ->capture_default_str();
  app.add_option("--classes", settings.classes, "near, touch, shallow, deep, nested (all; along a trajectory no deep)")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(pose_class_names.begin(), pose_class_names.end())));
  app.add_option("--poses", settings.poses, "poses of each class")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  app.add_option("--steps", settings.steps, "steps of a trajectory")
      ->check(CLI::Range(1, 10000000))
      ->capture_default_str();
  app.add_option("--repeat", settings.repeat, "the median of so many calls counts")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--builds", settings.builds, "the median of so many builds is shown")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "of the poses")->capture_default_str();
  app.add_option("--core", settings.core, "processor that queries run on (the current one)");
  app.add_option("--csv", settings.csv, "file for every pose's times");
  app.add_flag("--all", settings.all,
               "all contacts: 8 of ours made from all pairs, all of FCL and Bullet, --ode-contacts of ODE");
  app.add_option("--ode-contacts", settings.ode_contacts, "with --all: for so many ODE has room, and stops there")
      ->check(CLI::Range(1, 65535))
      ->capture_default_str();
  app.add_flag("--cpu-time", settings.cpu_time,
               "time of the thread instead of wall time: for a machine that does other work");
  app.add_option("--budgets-us", settings.budgets_us, "each method of ours also within so many microseconds")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_flag("--untested-leaves", settings.untested_leaves,
               "each volume of ours but wide also without a test of volumes between leaves");
  app.add_flag("--trajectory", settings.trajectory, "sliding motion");
  app.add_option("--step", settings.step, "way of each step along a trajectory, as a part of A's size")
      ->check(CLI::Range(1e-9, 0.1))
      ->capture_default_str();
}

void complete(Settings& settings) {
  if (settings.methods.empty()) settings.methods = {"exact"};
  if (settings.trajectory && settings.methods.size() == 1) settings.methods = {"incremental", "exact"};
  if (settings.classes.empty()) {
    settings.classes.assign(pose_class_names.begin(), pose_class_names.end());
    if (settings.trajectory) settings.classes = {"near", "touch", "shallow"};
  }
#ifndef ODDS_WITH_BULLET
  if (std::erase(settings.peers, "bullet") != 0) {
    std::printf("Bullet was not found when this was built (Debian: libbullet-dev): left out\n");
  }
#endif
}

}  // namespace
}  // namespace odds::benchmark

int main(int argc, char** argv) {
  using namespace odds::benchmark;
  Settings settings;
  CLI::App app("This library and other engines on the same poses; ratios are to the first line of each table.");
  add_options(app, settings);
  CLI11_PARSE(app, argc, argv);
  complete(settings);
  try {
    std::ofstream csv;
    if (!settings.csv.empty()) {
      csv.open(settings.csv);
      if (!csv) throw std::runtime_error(settings.csv + ": cannot be written; choose another place");
      csv << "mesh,class,pose,engine,us,contacts,fcl\n";
    }
    Ratios ratios;
    for (const Workload& workload : load_workloads(settings)) compare(settings, workload, ratios, csv);
    ratios.print();
    if (csv.is_open() && !csv.flush()) throw std::runtime_error(settings.csv + ": could not be written whole");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
