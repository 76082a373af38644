// odds_figure: time and error of several ways to ask whether two copies of a body meet, against their distance, as in
// figure 4.17 of Langetepe and Zachmann. Writes a table and a picture for each mesh.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "figure/chart.hpp"
#include "odds/mesh/made/by_name.hpp"
#include "odds/mesh/read.hpp"
#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "odds/report/accuracy/poses.hpp"

namespace odds::figure {
namespace {

using query::EstimatorKind;
using query::Method;

struct Options {
  std::vector<std::string> meshes = {"made:car_body:triangles=60000",
                                     "/usr/share/doc/openfoam-examples/examples/resources/geometry/motorBike.obj.gz"};
  std::uint64_t poses = 100;
  std::uint64_t seed = 1;
  std::string out;
};

/// One way to ask.
struct Way {
  std::string name;
  volume::Kind volume;
  query::Request request;
  std::string color;
  bool dashed = false;
};

query::Request exact() {
  query::Request request;
  request.method = Method::exact;
  request.max_contacts = 0;
  return request;
}

query::Request stopped(EstimatorKind estimator, double p_min, std::uint32_t k_min) {
  query::Request request;
  request.estimator = estimator;
  request.p_min = p_min;
  request.k_min = k_min;
  request.max_contacts = 0;
  return request;
}

query::Request within(double microseconds) {
  query::Request request;
  request.budget.microseconds = microseconds;
  request.max_contacts = 0;
  return request;
}

std::vector<Way> ways() {
  std::vector<Way> all = {{"exact, tree of 18-DOPs", volume::Kind::kdop18, exact(), "#000", true},
                          {"exact, tree of boxes", volume::Kind::aabb, exact(), "#777", true},
                          {"exact, wide engine", volume::Kind::wide, exact(), "#1a7f37", true}};
  const std::vector<std::pair<double, std::string>> thresholds = {
      {0.99, "#7a0019"}, {0.9, "#c1272d"}, {0.7, "#e8743b"}, {0.5, "#f2b134"}};
  for (const auto& [p_min, color] : thresholds) {
    all.push_back({fmt::format("cells on boxes, p_min {}", p_min), volume::Kind::aabb,
                   stopped(EstimatorKind::cells, p_min, 10), color});
  }
  all.push_back(
      {"cells on 18-DOPs, p_min 0.9", volume::Kind::kdop18, stopped(EstimatorKind::cells, 0.9, 10), "#8c564b"});
  all.push_back(
      {"kinematic on boxes, p_min 0.9", volume::Kind::aabb, stopped(EstimatorKind::kinematic, 0.9, 10), "#2a6fdb"});
  all.push_back(
      {"kinematic, wide engine, p_min 0.9", volume::Kind::wide, stopped(EstimatorKind::kinematic, 0.9, 10), "#7b3fbf"});
  all.push_back({"wide engine, 2 us", volume::Kind::wide, within(2.0), "#0aa2a2"});
  return all;
}

/// Sums of one way over the poses of one band.
struct Sum {
  std::uint64_t count = 0, wrong = 0;
  double microseconds = 0.0;
};

struct Measured {
  Way way;
  std::vector<Sum> bands;
};

struct Posed {
  math::Pose pose;
  std::uint32_t band = 0;
  bool hit = false;
};

using SharedMesh = std::shared_ptr<const mesh::TriangleMesh>;
using SharedShape = std::shared_ptr<const query::Shape>;

Result<SharedShape> build(const SharedMesh& mesh, volume::Kind volume) {
  query::ShapeOptions options;
  options.volume = volume;
  return query::Shape::build(mesh, options);
}

Result<std::vector<Posed>> make_poses(const SharedShape& shape, const Options& options) {
  auto maker = report::PoseMaker::make(shape, shape, report::Procedure::tumbling, options.seed);
  if (!maker.ok()) return maker.error();
  auto pair = query::Pair::make(shape, shape);
  if (!pair.ok()) return pair.error();
  std::vector<Posed> poses;
  for (std::uint64_t i = 0; i < options.poses * report::pose_bands(report::Procedure::tumbling).size(); ++i) {
    const auto made = maker.value().pose(i);
    if (!made.ok()) return made.error();
    Posed posed{made.value().pose(), made.value().band, false};
    posed.hit = pair.value().run(posed.pose, exact()).verdict == query::Verdict::hit;
    poses.push_back(posed);
  }
  return poses;
}

/// The least of three: what other programs took is not the way's.
double time_of(query::Pair& pair, const Posed& posed, const query::Request& request, bool& wrong) {
  const realtime::Clock clock = realtime::fastest_clock();
  double least = 1e300;
  for (int i = 0; i < 3; ++i) {
    pair.reset();
    const std::int64_t begin = clock();
    const query::Answer& answer = pair.run(posed.pose, request);
    least = std::min(least, 1e-3 * static_cast<double>(clock() - begin));
    wrong = (answer.verdict == query::Verdict::hit) != posed.hit;
  }
  return least;
}

Result<std::vector<Measured>> measure(const SharedMesh& mesh, const Options& options) {
  std::map<volume::Kind, SharedShape> shapes;
  for (const Way& way : ways()) {
    if (shapes.contains(way.volume)) continue;
    auto built = build(mesh, way.volume);
    if (!built.ok()) return built.error();
    shapes[way.volume] = built.value();
  }
  const auto poses = make_poses(shapes[volume::Kind::wide], options);
  if (!poses.ok()) return poses.error();
  std::vector<Measured> all;
  for (const Way& way : ways()) {
    auto pair = query::Pair::make(shapes[way.volume], shapes[way.volume]);
    if (!pair.ok()) return pair.error();
    Measured measured{way, std::vector<Sum>(report::pose_bands(report::Procedure::tumbling).size())};
    for (const Posed& posed : poses.value()) {
      Sum& sum = measured.bands[posed.band];
      bool wrong = false;
      sum.microseconds += time_of(pair.value(), posed, way.request, wrong);
      sum.wrong += wrong ? 1 : 0;
      ++sum.count;
    }
    all.push_back(std::move(measured));
  }
  return all;
}

/// Means over all distances from touch to one size, each the same weight, as the papers' poses have them.
struct Mean {
  double microseconds = 0.0;
  double error = 0.0;
};

Mean mean_over_distance(const Measured& measured) {
  const auto bands = report::pose_bands(report::Procedure::tumbling);
  Mean mean;
  double width = 0.0;
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const Sum& sum = measured.bands[k];
    if (bands[k].least < 0.0 || sum.count == 0) continue;
    const double w = bands[k].greatest - bands[k].least;
    mean.microseconds += w * sum.microseconds / static_cast<double>(sum.count);
    mean.error += w * static_cast<double>(sum.wrong) / static_cast<double>(sum.count);
    width += w;
  }
  return {mean.microseconds / width, mean.error / width};
}

/// The exact search of the same tree.
Mean exact_of_same_volume(const std::vector<Measured>& all, const Measured& one) {
  const auto exact = std::find_if(all.begin(), all.end(), [&](const Measured& other) {
    return other.way.volume == one.way.volume && other.way.request.method == Method::exact;
  });
  return mean_over_distance(exact != all.end() ? *exact : one);
}

std::string table(const std::string& mesh, const std::vector<Measured>& all) {
  const auto bands = report::pose_bands(report::Procedure::tumbling);
  std::string text = fmt::format("two copies of {}: microseconds (and share wrong) by distance\n{:<36}{:>20}{:>9}{:>9}",
                                 mesh, "", "mean of all apart", "x DOPs", "x own");
  for (const report::PoseBand& band : bands) text += fmt::format("{:>18}", band.name);
  text += "\n";
  const double of_dops = mean_over_distance(all.front()).microseconds;
  for (const Measured& one : all) {
    const Mean mean = mean_over_distance(one);
    text +=
        fmt::format("{:<36}{:>11.2f} ({:>5.2f}%){:>9.2f}{:>9.2f}", one.way.name, mean.microseconds, 100.0 * mean.error,
                    of_dops / mean.microseconds, exact_of_same_volume(all, one).microseconds / mean.microseconds);
    for (const Sum& sum : one.bands) {
      const auto n = static_cast<double>(std::max<std::uint64_t>(sum.count, 1));
      text += fmt::format("{:>9.2f} ({:>5.1f}%)", sum.microseconds / n, 100.0 * static_cast<double>(sum.wrong) / n);
    }
    text += "\n";
  }
  return text;
}

std::string csv(const std::vector<Measured>& all) {
  const auto bands = report::pose_bands(report::Procedure::tumbling);
  std::string text = "way,band,least,greatest,poses,wrong,mean_us\n";
  for (const Measured& one : all) {
    for (std::size_t k = 0; k < bands.size(); ++k) {
      const Sum& sum = one.bands[k];
      if (sum.count == 0) continue;
      text += fmt::format("\"{}\",{},{},{},{},{},{}\n", one.way.name, bands[k].name, bands[k].least, bands[k].greatest,
                          sum.count, sum.wrong, sum.microseconds / static_cast<double>(sum.count));
    }
  }
  return text;
}

/// Beyond, all ways take as long as a call does.
constexpr double drawn_to = 0.4;

std::string picture(const std::string& mesh, const std::vector<Measured>& all) {
  const auto bands = report::pose_bands(report::Procedure::tumbling);
  Panel time{
      "time: two copies of " + mesh, "distance from first touch, parts of the size", "microseconds, mean", true, {}};
  Panel error{"error", time.x_title, "% of verdicts wrong", false, {}};
  for (const Measured& one : all) {
    Curve t{one.way.name, one.way.color, one.way.dashed, {}, {}};
    Curve e = t;
    for (std::size_t k = 0; k < bands.size(); ++k) {
      const Sum& sum = one.bands[k];
      if (sum.count == 0 || bands[k].greatest > drawn_to) continue;
      const auto n = static_cast<double>(sum.count);
      t.x.push_back(0.5 * (bands[k].least + bands[k].greatest));
      e.x.push_back(t.x.back());
      t.y.push_back(sum.microseconds / n);
      e.y.push_back(100.0 * static_cast<double>(sum.wrong) / n);
    }
    time.curves.push_back(std::move(t));
    error.curves.push_back(std::move(e));
  }
  return chart_svg({time, error});
}

int run(const Options& options) {
  std::filesystem::create_directories(options.out);
  for (const std::string& name : options.meshes) {
    if (!name.starts_with(mesh::made::prefix) && !std::filesystem::exists(name)) {
      fmt::print(stderr, "left out: {} (Debian: openfoam-examples)\n", name);
      continue;
    }
    auto mesh = name.starts_with(mesh::made::prefix) ? mesh::made::make_shape(name) : mesh::read(name);
    if (!mesh.ok()) {
      fmt::print(stderr, "{}\n", mesh.error().message());
      return 1;
    }
    const std::string title = std::filesystem::path(name).filename().string().substr(0, name.find(':', 5));
    const auto shared = std::make_shared<const mesh::TriangleMesh>(std::move(mesh).value());
    const std::string label = fmt::format("{} ({} triangles)", title, shared->triangles().size());
    const auto measured = measure(shared, options);
    if (!measured.ok()) {
      fmt::print(stderr, "{}\n", measured.error().message());
      return 1;
    }
    fmt::print("{}\n", table(label, measured.value()));
    const std::string stem = shared->name().starts_with("made") || name.starts_with(mesh::made::prefix)
                                 ? "made_car_body"
                                 : title.substr(0, title.find('.'));
    std::ofstream(std::filesystem::path(options.out) / (stem + ".csv")) << csv(measured.value());
    std::ofstream(std::filesystem::path(options.out) / (stem + ".svg")) << picture(label, measured.value());
  }
  return 0;
}

}  // namespace
}  // namespace odds::figure

int main(int argc, char** argv) {
  odds::figure::Options options;
  CLI::App app("Time and error of two copies of a body against their distance (figure 4.17)");
  app.add_option("--out", options.out, "folder for tables and pictures")->required();
  app.add_option("--mesh", options.meshes, "files or made: names; default: the made car and a real motorcycle");
  app.add_option("--poses", options.poses, "for each of seven distances")->check(CLI::Range(1, 1000000));
  app.add_option("--seed", options.seed, "of the poses");
  CLI11_PARSE(app, argc, argv);
  return odds::figure::run(options);
}
