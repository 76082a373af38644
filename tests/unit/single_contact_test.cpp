// A single contact is made with the same care however late its hit comes.
#include <gtest/gtest.h>

#include <memory>

#include "odds/query/pair.hpp"
#include "odds/realtime/clock.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

std::shared_ptr<const Shape> ball() { return Shape::build(testing::wavy_sphere(24, 0.02)).value(); }

/// A pose in which two of them overlap by a trifle.
math::Pose met(int i) {
  return {Eigen::AngleAxisd(0.3 * i, Vec3(1.0, 0.2 * i, 0.5).normalized()).toRotationMatrix(), Vec3(1.97, 0.05, 0.0)};
}

/// Within 5 us of a clock that goes on by so much a look.
Answer run(Pair& pair, int i, std::int64_t step_ns) {
  realtime::ManualClock clock(step_ns);
  Request request{.method = Method::exact, .budget = Budget::time(5.0)};
  request.budget.clock = clock.clock();
  pair.reset();
  return pair.run(met(i), request);
}

TEST(SingleContact, IsNoRougherWhereItsHitComesLast) {
  const std::shared_ptr<const Shape> shape = ball();
  Pair pair = Pair::make(shape, shape).value();
  int hits = 0;
  int last = 0;
  for (int i = 0; i < 20; ++i) {
    const Answer unhurried = run(pair, i, 1);
    if (unhurried.verdict != Verdict::hit) continue;
    const Contact expected = unhurried.contacts.front();
    for (std::int64_t step_ns = 20; step_ns <= 1500; step_ns += 10) {
      const Answer answer = run(pair, i, step_ns);
      if (answer.basis != Basis::proved) continue;
      ASSERT_EQ(answer.contacts.size(), 1U);
      EXPECT_TRUE(answer.contacts_complete);
      const Contact& contact = answer.contacts.front();
      // Near its end a search opens fewer pairs at a time, and may find another hit.
      if (contact.triangle_a != expected.triangle_a || contact.triangle_b != expected.triangle_b) continue;
      ++hits;
      EXPECT_EQ(contact.position, expected.position) << i << ", " << step_ns;
      EXPECT_EQ(contact.depth, expected.depth) << i << ", " << step_ns;
      // Only what the bodies are about the triangles is left out where there is no time for it.
      last += contact.normal != expected.normal ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(last, 20);
  EXPECT_LT(last, hits - 20);
}

}  // namespace
}  // namespace odds::query
