// odds_fuzz_scenes: feeds mutated scene files and device tracks to their readers, and runs what they accept for a few
// ticks.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "fuzz_run.hpp"
#include "odds/haptics/device_track.hpp"
#include "odds/haptics/replay_device.hpp"
#include "odds/math/random.hpp"
#include "odds/scene/simulation.hpp"

namespace odds::fuzz {
namespace {

constexpr unsigned hang_seconds = 120;

constexpr std::array<std::string_view, 22> numbers = {
    "0",   "-1",   "1e-12", "1e-300", "1e12", "1.0001e12", "1e308", "-1e6",  "nan", "inf", "-inf",
    "0.5", "1000", "3",     "64",     "1e3",  "1e-6",      "true",  "\"x\"", "[]",  "{}",  "[1, 2, 3]"};

/// The n-th input of a seed does not depend on the others.
class Mutator {
 public:
  Mutator(std::uint64_t seed, std::vector<std::string> texts) : seed_(seed), texts_(std::move(texts)) {
    for (const std::string& text : texts_) {
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) pool_.push_back(line);
    }
  }
  std::string input(std::uint64_t n) {
    random_ = math::Random(seed_, n);
    std::string text = texts_[random_.below(texts_.size())];
    for (std::uint64_t i = 1 + random_.below(3); i > 0; --i) mutate(text);
    return text;
  }

 private:
  void mutate(std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    if (lines.empty()) return;
    const std::size_t at = random_.below(lines.size());
    switch (random_.below(8)) {
      case 0:
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), pool_[random_.below(pool_.size())]);
        break;
      case 2:
        std::swap(lines[at], lines[random_.below(lines.size())]);
        break;
      case 3:
        if (!lines[at].empty()) lines[at][random_.below(lines[at].size())] = static_cast<char>(random_.below(256));
        break;
      default:
        change_number(lines[at]);
    }
    text.clear();
    for (const std::string& line : lines) text += line + "\n";
  }
  // The value of a key, or one of the numbers of a list, becomes another.
  void change_number(std::string& line) {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (!std::isdigit(static_cast<unsigned char>(line[i])) && line[i] != '-') continue;
      const std::size_t end = std::min(line.find_first_not_of("0123456789.eE-+", i), line.size());
      found.emplace_back(i, end - i);
      i = end;
    }
    if (found.empty()) return;
    const auto [begin, length] = found[random_.below(found.size())];
    line.replace(begin, length, numbers[random_.below(numbers.size())]);
  }
  std::uint64_t seed_;
  std::vector<std::string> texts_;
  std::vector<std::string> pool_;
  math::Random random_{0};
};

std::string read_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> scene_texts() {
  std::vector<std::string> texts;
  for (const char* folder : {"demos/scenes", "tests/fuzz/seeds"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(ODDS_SOURCE_DIR) / folder)) {
      if (entry.path().extension() == ".toml") texts.push_back(read_whole(entry.path()));
    }
  }
  std::sort(texts.begin(), texts.end());
  return texts;
}

const std::string track =
    "t_ns,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n0,0,0,0.1,1,0,0,0,0\n1000000,0,0,0.09,1,0,0,0,1\n"
    "2500000,0.01,0,0.08,0.7071067811865476,0,0.7071067811865476,0,0\n4000000,0,0,0.1,1,0,0,0,0\n";

struct Totals {
  std::uint64_t accepted = 0;
  std::uint64_t refused = 0;
  std::uint64_t ran = 0;
  std::uint64_t not_built = 0;
  std::uint64_t tracks = 0;
  std::set<std::string> remedies;
};

std::string complaint(const Error& error) {
  if (error.what.empty() || error.remedy.empty()) return "an error without words: " + error.message();
  if (error.file != "fuzz.toml") return "an error that does not name its file: " + error.message();
  return "";
}

bool finite(const haptics::TickRecord& t) {
  double sum = t.max_depth_m + t.observed_energy_j;
  for (const double x : t.force_n) sum += x;
  for (const double x : t.torque_nm) sum += x;
  for (const double x : t.tool_position_m) sum += x;
  return std::isfinite(sum);
}

/// A few ticks of an accepted scene, with boxes in the place of its meshes so that no input takes long.
std::string run(scene::Scene scene, Totals& totals) {
  if (scene.bodies.size() > 8 || (scene.device && scene.device->type == "replay")) return "";
  for (scene::Mesh& mesh : scene.meshes) {
    mesh.file = "made:box:x=0.02,y=0.02,z=0.02";
    mesh.scale = 1.0;
  }
  const double most_force = scene.device ? scene.device->limits.max_force_n : 0.0;
  scene::SimulationOptions options;
  options.simulated_time = true;
  options.seconds = 20.0 * scene.loop.period_s();
  auto made = scene::Simulation::make(std::move(scene), options);
  if (!made) {
    ++totals.not_built;
    return made.error().what.empty() ? "no words for a scene that cannot be built" : "";
  }
  scene::Simulation& simulation = *made.value();
  ++totals.ran;
  for (std::int64_t i = 0; i < 5; ++i) {
    haptics::TickRecord record;
    simulation.renderer().tick(i * simulation.scene().loop.period_ns, record);
    if (!finite(record)) return "a tick with numbers that are not finite";
    const double force = Vec3(record.force_n[0], record.force_n[1], record.force_n[2]).stableNorm();
    if (force > most_force * (1.0 + 1e-9)) return "a force beyond the limit";
    for (std::uint32_t body = 0; body < simulation.world().body_count(); ++body) {
      if (!simulation.world().state({body}).pose.is_rigid(1e-3)) return "a body whose pose is none";
    }
  }
  return "";
}

std::string judge_scene(const std::string& text, Totals& totals) {
  Result<scene::Scene> parsed = scene::parse_scene(text, "fuzz.toml", ".");
  if (!parsed) {
    ++totals.refused;
    totals.remedies.insert(parsed.error().remedy.substr(0, 24));
    return complaint(parsed.error());
  }
  ++totals.accepted;
  const scene::Scene& scene = parsed.value();
  if (scene.bodies.empty() || scene.loop.period_ns <= 0) return "a scene that cannot be was accepted";
  if (scene.make_effects()->size() != scene.effects.size()) return "an effect that was accepted cannot be made";
  for (const scene::Body& body : scene.bodies) {
    if (!body.pose.is_rigid(1e-3)) return "a pose that is none was accepted";
  }
  return run(std::move(parsed).value(), totals);
}

std::string judge_track(const std::string& text, Totals& totals) {
  Result<haptics::DeviceTrack> parsed = haptics::parse_track(text, "fuzz.toml");
  if (!parsed) return complaint(parsed.error());
  ++totals.tracks;
  const auto& states = parsed.value().states;
  if (states.empty()) return "a track without a state was accepted";
  for (std::size_t i = 1; i < states.size(); ++i) {
    if (states[i].t_ns <= states[i - 1].t_ns) return "a track whose time does not grow was accepted";
  }
  haptics::ReplayDevice device(std::move(parsed).value());
  for (const std::int64_t now_ns : {std::int64_t{0}, std::int64_t{1'700'000}, std::int64_t{1} << 60, std::int64_t{3}}) {
    haptics::DeviceState state;
    if (!device.read(now_ns, state)) return "a replay that gives no state";
    if (!state.position_m.allFinite() || !state.velocity_m_per_s.allFinite() ||
        !state.orientation.coeffs().allFinite()) {
      return "a replayed state that is not finite";
    }
  }
  return "";
}

int run_all(const RunOptions& options) {
  Mutator scenes(options.seed, scene_texts());
  Mutator tracks(options.seed + 1, {track});
  Totals totals;
  const bool good = run_inputs(options, hang_seconds, "fuzz_failure.toml", [&](std::uint64_t n) {
    const bool is_track = n % 4 == 3;
    std::string text = is_track ? tracks.input(n) : scenes.input(n);
    std::string wrong = is_track ? judge_track(text, totals) : judge_scene(text, totals);
    return Judged{std::move(text), std::move(wrong)};
  });
  if (!good) return 1;
  std::printf(
      "%llu inputs (seed %llu): %llu scenes accepted, %llu refused with %zu kinds of remedies, %llu ran for 5 ticks, "
      "%llu could not be built, %llu tracks accepted\n",
      static_cast<unsigned long long>(options.count), static_cast<unsigned long long>(options.seed),
      static_cast<unsigned long long>(totals.accepted), static_cast<unsigned long long>(totals.refused),
      totals.remedies.size(), static_cast<unsigned long long>(totals.ran),
      static_cast<unsigned long long>(totals.not_built), static_cast<unsigned long long>(totals.tracks));
  return 0;
}

}  // namespace
}  // namespace odds::fuzz

int main(int argc, char** argv) {
  odds::fuzz::RunOptions options;
  if (!odds::fuzz::read_options(argc, argv, false, options)) {
    std::fprintf(stderr,
                 "usage: odds_fuzz_scenes [--count N] [--seed S] [--first N]\n"
                 "Three of four inputs are scenes, the others device tracks. Exit status 1 and fuzz_failure.toml if "
                 "one fails.\n");
    return 2;
  }
  return odds::fuzz::run_all(options);
}
