// What contacts that were made in haste, run after run, say together.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "odds/math/pose.hpp"
#include "odds/math/tolerances.hpp"
#include "odds/query/answer.hpp"
#include "odds/query/contact_patch.hpp"
#include "query/known/guessed_depth.hpp"
#include "query/known/place_spread.hpp"

namespace odds::query {

/// What one pair of triangles that cross says of the direction in which the bodies part: along the normal of one of
/// them, into A, as much rather as the two overlap less along it. Of a face that lies on a face, whatever the sides
/// say.
struct Vote {
  Vec3 direction = Vec3::Zero();  ///< unit, or zero where neither has a normal
  double weight = 0.0;            ///< of the part of rim that they cross in

  /// Of a direction where another one is expected, squared cosine, or where none is (zero).
  [[nodiscard]] static double likelihood(const Vec3& direction, const Vec3& expected) noexcept {
    if (expected.isZero()) return 1.0;
    const double along = unlikely + std::max(0.0, direction.dot(expected));
    return along * along;
  }
  static constexpr double unlikely = 0.05;

  /// `overlap_b`, `overlap_a`: along B's normal and against A's, metres; `length` of the crossing; `little`: overlaps
  /// below it are alike.
  [[nodiscard]] static Vote of(const Vec3& normal_a, const Vec3& normal_b, double overlap_a, double overlap_b,
                               double length, double little, const Vec3& expected) noexcept {
    const double by_a = likelihood(-normal_a, expected) / (overlap_a + little);
    const double by_b = likelihood(normal_b, expected) / (overlap_b + little);
    const Vec3 sum = by_b * normal_b - by_a * normal_a;
    const double size = sum.norm();
    if (!(size > 1e-6 * (by_a + by_b))) return {};
    return {sum / size, (length + little) * std::max(by_a, by_b)};
  }
};

/// A run without time for a patch sees a few pieces of the rim, which lean to their side of it and bear at one corner.
/// Over some dozens of runs others are seen, what sides say sideways cancels out, and the corners support the body
/// together. All in A's mesh frame, metres.
class HastyMemory {
 public:
  GuessedDepth guessed;  ///< depth of contacts
  PlaceSpread spread;    ///< of places that were seen

  void forget() noexcept {
    lean_.setZero();
    weight_ = 0.0;
    count_ = 0;
    guessed.forget();
    spread.forget();
  }

  /// A run begins with B at `pose` in A; `slack`: by so much a remembered place may part sideways. `centre`: of the
  /// smaller body, as the larger one sees it; of bodies that have moved by more than `far` since the last run, it is
  /// elsewhere that they touch. Metres.
  void begin(const math::Pose& pose, const Vec3& centre, double slack, double far) noexcept {
    if (!((centre - centre_).norm() <= far)) forget();
    centre_ = centre;
    lean_ *= kept;
    weight_ *= kept;
    std::size_t left = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      Place& place = places_[i];
      if (++place.runs > oldest || !((pose * place.on_b - place.on_a).norm() <= slack)) continue;
      places_[left++] = place;
    }
    count_ = left;
  }
  /// Directions are to be others in A's frame.
  void turn(const Mat3& turned) noexcept {
    lean_ = turned * lean_;
    for (Place& place : std::span(places_).first(count_)) place.normal = turned * place.normal;
  }
  /// `sum` of votes' directions times weights, and of the weights.
  void see(const Vec3& sum, double weight) noexcept {
    if (!sum.allFinite() || !(weight > 0.0)) return;
    lean_ += sum;
    weight_ += weight;
  }

  /// Whether anything was seen.
  [[nodiscard]] bool has_seen() const noexcept { return weight_ > 0.0; }
  /// Whether what was seen points one way; else there are contacts that push against each other.
  [[nodiscard]] bool is_of_one_mind() const noexcept { return lean_.norm() > one_mind * weight_; }
  /// Whether it points one way for the most part, with little that pushes elsewhere.
  [[nodiscard]] bool is_unanimous() const noexcept { return has_seen() && lean_.norm() > unanimous * weight_; }
  /// Unit, into A. Precondition: is_of_one_mind().
  [[nodiscard]] Vec3 direction() const noexcept { return lean_.normalized(); }

  /// Adds the places of contacts; a new one near to a remembered one takes its turn.
  void remember(std::span<const Contact> contacts, const math::Pose& pose, double near) noexcept {
    const math::Pose back = pose.inverse();
    for (const Contact& contact : contacts) {
      std::size_t at = count_;
      for (std::size_t i = 0; i < count_ && at == count_; ++i) {
        if ((places_[i].on_a - contact.position).norm() <= near) at = i;
      }
      if (at == places_.size()) at = nearest(contact.position);
      places_[at] = {contact.position,
                     back * contact.position,
                     contact.normal,
                     contact.depth,
                     contact.triangle_a,
                     contact.triangle_b,
                     0};
      count_ = std::max(count_, at + 1);
    }
  }

  /// How many places are remembered, and which triangles crossed in each.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] TrianglePair pair_of(std::size_t place) const noexcept {
    return {places_[place].triangle_a, places_[place].triangle_b};
  }

  /// Appends to the `made` first of `contacts` those remembered places that are not near one of them, with `normal`, or
  /// their own where it is null or across theirs. Returns how many there are then.
  [[nodiscard]] std::size_t add_to(std::span<Contact> contacts, std::size_t made, const Vec3* normal,
                                   const math::Pose& pose, double near) const noexcept {
    for (std::size_t i = 0; i < count_ && made < contacts.size(); ++i) {
      const Place& place = places_[i];
      const Vec3 now = pose * place.on_b;
      const auto is_near = [&](const Contact& contact) noexcept { return (contact.position - now).norm() <= near; };
      if (std::any_of(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(made), is_near)) continue;
      const Vec3 direction =
          normal != nullptr && place.normal.dot(*normal) > tolerances::hasty_across ? *normal : place.normal;
      const double depth = place.depth + direction.dot(now - place.on_a);
      if (!(depth >= 0.0)) continue;  // it has parted there
      contacts[made++] = {now, direction, depth, place.triangle_a, place.triangle_b};
    }
    return made;
  }
  /// Appends to the `made` first of `contacts`, which are known well, those remembered places that are not near one of
  /// them, were guessed to push as the first of them does, and have come deeper since: they hold what nobody has looked
  /// at. By so much, `most_depth` at most. Returns how many there are then.
  [[nodiscard]] std::size_t hold_beside(std::span<Contact> contacts, std::size_t made, const math::Pose& pose,
                                        double near, double most_depth) const noexcept {
    if (made == 0) return 0;
    const Vec3 normal = contacts.front().normal;
    for (std::size_t i = 0; i < count_ && made < contacts.size(); ++i) {
      const Place& place = places_[i];
      if (!(place.normal.dot(normal) > tolerances::hasty_agreement)) continue;
      const Vec3 now = pose * place.on_b;
      const double deeper = normal.dot(now - place.on_a);
      if (!(deeper > 0.0)) continue;
      const auto is_near = [&](const Contact& contact) noexcept { return (contact.position - now).norm() <= near; };
      if (std::any_of(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(made), is_near)) continue;
      contacts[made++] = {now, normal, std::min(deeper, most_depth), place.triangle_a, place.triangle_b};
    }
    return made;
  }

 private:
  struct Place {
    Vec3 on_a = Vec3::Zero();  ///< where it was found
    Vec3 on_b = Vec3::Zero();  ///< the same point of B, in B's frame
    Vec3 normal = Vec3::UnitZ();
    double depth = 0.0;
    std::uint32_t triangle_a = 0;
    std::uint32_t triangle_b = 0;
    std::uint32_t runs = 0;  ///< since it was found
  };

  static constexpr double kept = 0.95;
  static constexpr double one_mind = 0.4;
  static constexpr double unanimous = 0.8;
  static constexpr std::uint32_t oldest = 200;

  /// Its turn it is, for those elsewhere support the body elsewhere.
  [[nodiscard]] std::size_t nearest(const Vec3& position) const noexcept {
    std::size_t at = 0;
    for (std::size_t i = 1; i < count_; ++i) {
      if ((places_[i].on_a - position).squaredNorm() < (places_[at].on_a - position).squaredNorm()) at = i;
    }
    return at;
  }

  Vec3 centre_ = Vec3::Zero();  ///< in the last run that began
  Vec3 lean_ = Vec3::Zero();
  double weight_ = 0.0;
  std::array<Place, most_contacts> places_;
  std::size_t count_ = 0;
};

}  // namespace odds::query
