// Poses at chosen distances from first touch.
#include "odds/report/accuracy/poses.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "query/memory/first_touch.hpp"

namespace odds::report {
namespace {

constexpr std::array<PoseBand, 12> distance_bands{{{"near 5 %", "near", 0.05, 0.05},
                                                   {"near 1 %", "near", 0.01, 0.01},
                                                   {"near 0.2 %", "near", 0.002, 0.002},
                                                   {"near 0.1 %", "near", 1e-3, 1e-3},
                                                   {"touch +1e-4", "touch", 1e-4, 1e-4},
                                                   {"touch +1e-6", "touch", 1e-6, 1e-6},
                                                   {"touch -1e-6", "touch", -1e-6, -1e-6},
                                                   {"touch -1e-4", "touch", -1e-4, -1e-4},
                                                   {"shallow 0.1 %", "shallow", -1e-3, -1e-3},
                                                   {"shallow 1 %", "shallow", -1e-2, -1e-2},
                                                   {"deep 10 %", "deep", -0.1, -0.1},
                                                   {"deep 30 %", "deep", -0.3, -0.3}}};

// From contact to one size away, as in the papers; and a little beyond contact, without which no hit could be missed.
constexpr std::array<PoseBand, 7> tumbling_bands{{{"overlap 0-10 %", "overlap", -0.1, 0.0},
                                                  {"apart 0-2 %", "apart", 0.0, 0.02},
                                                  {"apart 2-5 %", "apart", 0.02, 0.05},
                                                  {"apart 5-10 %", "apart", 0.05, 0.1},
                                                  {"apart 10-20 %", "apart", 0.1, 0.2},
                                                  {"apart 20-40 %", "apart", 0.2, 0.4},
                                                  {"apart 40-100 %", "apart", 0.4, 1.0}}};

constexpr std::array<PoseBand, 8> nested_bands{{{"near 0.2 %", "near", 0.002, 0.002},
                                                {"near 0.1 %", "near", 1e-3, 1e-3},
                                                {"touch +1e-4", "touch", 1e-4, 1e-4},
                                                {"touch +1e-6", "touch", 1e-6, 1e-6},
                                                {"touch -1e-6", "touch", -1e-6, -1e-6},
                                                {"touch -1e-4", "touch", -1e-4, -1e-4},
                                                {"shallow 0.1 %", "shallow", -1e-3, -1e-3},
                                                {"shallow 0.2 %", "shallow", -0.002, -0.002}}};

constexpr double step_share = 1.0 / 64.0;
constexpr double nested_step_share = 1.0 / 4096.0;
constexpr double greatest_nested_turn = 0.2 * std::numbers::pi / 180.0;
constexpr double most_steps = 4096.0;
constexpr double touch_precision = 1e-12;    ///< of the size
constexpr double distance_precision = 1e-3;  ///< of the distance
constexpr int most_lines_tried = 1000;

Vec3 center_of(const mesh::TriangleMesh& mesh) { return 0.5 * (mesh.lower() + mesh.upper()); }

}  // namespace

std::string_view name(Procedure procedure) noexcept {
  switch (procedure) {
    case Procedure::distance:
      return "distance";
    case Procedure::tumbling:
      return "tumbling";
    case Procedure::nested:
      break;
  }
  return "nested";
}

std::span<const PoseBand> pose_bands(Procedure procedure) noexcept {
  if (procedure == Procedure::distance) return distance_bands;
  if (procedure == Procedure::tumbling) return tumbling_bands;
  return nested_bands;
}

math::Pose MadePose::pose() const {
  // The same operations as of whoever reads a file of poses.
  const double least = rotation.coeffs().minCoeff();
  const double greatest = rotation.coeffs().maxCoeff();
  const double largest = std::max(-least, greatest);
  return math::Pose::from_quaternion(translation, Quat(rotation.w() / largest, rotation.x() / largest,
                                                       rotation.y() / largest, rotation.z() / largest));
}

PoseMaker::PoseMaker(query::Pair pair, Procedure procedure, std::uint64_t seed)
    : pair_(std::move(pair)), procedure_(procedure), seed_(seed) {
  const mesh::TriangleMesh& a = pair_.a().mesh();
  const mesh::TriangleMesh& b = pair_.b().mesh();
  size_ = std::min(a.size(), b.size());
  reach_ = 0.5 * (a.size() + b.size());
  center_a_ = center_of(a);
  center_b_ = center_of(b);
}

Result<PoseMaker> PoseMaker::make(std::shared_ptr<const query::Shape> a, std::shared_ptr<const query::Shape> b,
                                  Procedure procedure, std::uint64_t seed) {
  for (const auto& shape : {a, b}) {
    if (shape && shape->volume() != volume::Kind::wide) {
      return Error{shape->mesh().name(), "", "poses are made by the wide engine, and this is another", "build it wide"};
    }
    if (shape && shape->mesh().size() <= 0.0) {
      return Error{shape->mesh().name(), "", "the mesh is a single point", "give a mesh with an extent"};
    }
  }
  auto pair = query::Pair::make(std::move(a), std::move(b));
  if (!pair.ok()) return pair.error();
  return PoseMaker(std::move(pair).value(), procedure, seed);
}

MadePose PoseMaker::at(const Line& line, double travel) const {
  MadePose made;
  made.rotation = line.rotation;
  made.translation = center_a_ + (line.touch + travel) * line.direction - made.pose().rotation * center_b_;
  return made;
}

bool PoseMaker::collides(const Line& line, double distance) {
  query::Request request;
  request.method = query::Method::exact;
  request.max_contacts = 0;
  return pair_.run(at(line, distance - line.touch).pose(), request).verdict == query::Verdict::hit;
}

PoseMaker::Line PoseMaker::draw_line(math::Random& random) const {
  Line line;
  if (procedure_ == Procedure::tumbling) {
    const double half_angle = std::numbers::pi * random.uniform();
    line.rotation = Quat(std::cos(half_angle), 0.0, 0.0, std::sin(half_angle));
    return line;
  }
  if (procedure_ == Procedure::nested) {
    const double angle = greatest_nested_turn * random.uniform();
    line.rotation = Quat(Eigen::AngleAxisd(angle, random.direction()));
  } else {
    line.rotation = random.rotation();
  }
  line.direction = random.direction();
  return line;
}

bool PoseMaker::find_touch(Line& line) {
  const double far = 1.01 * reach_;
  const bool nested = procedure_ == Procedure::nested;
  const double step = nested ? nested_step_share * size_ : std::max(step_share * size_, far / most_steps);
  const double begin = nested ? 0.0 : far;
  const double end = nested ? -far : 0.0;
  const auto touch = query::first_touch(begin, end, step, touch_precision * size_,
                                        [&](double distance) { return collides(line, distance); });
  if (!touch) return false;  // passed through a hole, or there was no room to begin in
  line.touch = *touch;
  return true;
}

Result<PoseMaker::Line> PoseMaker::line(std::uint64_t number) {
  if (number == line_number_) return line_;
  math::Random random(seed_, number);
  for (int tried = 0; tried < most_lines_tried; ++tried) {
    Line line = draw_line(random);
    if (!find_touch(line)) continue;
    line_number_ = number;
    line_ = line;
    return line;
  }
  return Error{pair_.b().mesh().name(), "",
               "never touched " + pair_.a().mesh().name() + " on " + std::to_string(most_lines_tried) +
                   " random lines through both centres",
               procedure_ == Procedure::nested
                   ? "give a B that fits into A about A's centre, such as a copy in which it is a little smaller"
                   : "give meshes that can meet, in the same unit (see --scale-a, --scale-b)"};
}

double PoseMaker::travel_to_distance(const Line& line, double distance) const {
  const auto within = [&](double travel) {
    return pair_.distance(at(line, travel).pose(), {.within = distance, .budget = {}}).upper <= distance;
  };
  double near = 0.0;
  double far = distance;
  while (within(far)) {
    near = far;
    far *= 1.5;
  }
  // A way of w changes the distance by no more than w, so the distance is right to the width of the bracket.
  while (far - near > distance_precision * distance) {
    const double middle = 0.5 * (near + far);
    (within(middle) ? near : far) = middle;
  }
  return far;
}

Result<MadePose> PoseMaker::pose(std::uint64_t index) {
  const auto bands = pose_bands(procedure_);
  const auto band = static_cast<std::uint32_t>(index % bands.size());
  const Result<Line> found = line(index / bands.size());
  if (!found.ok()) return found.error();
  const double share = math::Random(~seed_, index).uniform_at(0);
  const double offset = bands[band].least + share * (bands[band].greatest - bands[band].least);
  const bool surface = procedure_ == Procedure::distance && offset > 0.0;
  MadePose made = at(found.value(), surface ? travel_to_distance(found.value(), offset * size_) : offset * size_);
  made.index = index;
  made.band = band;
  made.offset = offset;
  return made;
}

}  // namespace odds::report
