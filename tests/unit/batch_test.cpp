#include "odds/query/batch.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "odds/math/random.hpp"
#include "support/shapes.hpp"

namespace odds::query {
namespace {

class BatchTest : public ::testing::Test {
 protected:
  BatchTest() {
    math::Random random(11);
    for (int i = 0; i < 700; ++i) {
      poses.push_back({random.rotation().toRotationMatrix(), random.uniform(1.5, 2.3) * random.direction()});
    }
  }
  [[nodiscard]] Batch batch(std::size_t threads) const { return Batch::make(a, b, {}, threads).value(); }

  std::shared_ptr<const Shape> a = Shape::build(testing::wavy_sphere(24)).value();
  std::shared_ptr<const Shape> b = Shape::build(testing::wavy_sphere(15)).value();
  std::vector<math::Pose> poses;
};

bool same(const Contact& x, const Contact& y) {
  return x.position == y.position && x.normal == y.normal && x.depth == y.depth && x.triangle_a == y.triangle_a &&
         x.triangle_b == y.triangle_b;
}

TEST_F(BatchTest, AnswersAsANewPairOnAnyNumberOfThreads) {
  for (const Method method : {Method::exact, Method::time_critical, Method::incremental}) {
    for (const Budget& budget : {Budget::unlimited(), Budget::work(60)}) {
      const Request request{.method = method, .budget = budget, .max_contacts = 4};
      std::vector<BatchAnswer> expected;
      std::vector<Contact> expected_contacts(4 * poses.size());
      int hits = 0;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        Pair fresh = Pair::make(a, b).value();
        Request alone = request;
        if (method == Method::incremental) alone.method = Method::exact;
        const Answer& answer = fresh.run(poses[i], alone);
        expected.push_back({answer.verdict, answer.basis, answer.probability,
                            static_cast<std::uint32_t>(answer.contacts.size()), answer.contacts_complete, answer.cost});
        std::copy(answer.contacts.begin(), answer.contacts.end(), expected_contacts.begin() + 4 * std::ptrdiff_t(i));
        hits += answer.verdict == Verdict::hit ? 1 : 0;
      }
      EXPECT_GT(hits, 100);
      EXPECT_LT(hits, 600);
      for (const std::size_t threads : {1U, 2U, 5U}) {
        Batch some = batch(threads);
        ASSERT_EQ(some.threads(), threads);
        std::vector<BatchAnswer> answers(poses.size());
        std::vector<Contact> contacts(4 * poses.size());
        ASSERT_FALSE(some.run(poses, request, answers, contacts).has_value());
        for (std::size_t i = 0; i < poses.size(); ++i) {
          ASSERT_EQ(answers[i].verdict, expected[i].verdict) << i;
          ASSERT_EQ(answers[i].basis, expected[i].basis) << i;
          ASSERT_EQ(answers[i].probability, expected[i].probability) << i;
          ASSERT_EQ(answers[i].cost.node_pairs, expected[i].cost.node_pairs) << i;
          ASSERT_EQ(answers[i].cost.triangle_pairs, expected[i].cost.triangle_pairs) << i;
          ASSERT_EQ(answers[i].contacts, expected[i].contacts) << i;
          ASSERT_EQ(answers[i].contacts_complete, expected[i].contacts_complete) << i;
          for (std::size_t k = 0; k < answers[i].contacts; ++k) {
            ASSERT_TRUE(same(contacts[4 * i + k], expected_contacts[4 * i + k])) << i;
          }
        }
      }
    }
  }
}

TEST_F(BatchTest, ContactsNeedNotBeTaken) {
  std::vector<BatchAnswer> answers(poses.size());
  ASSERT_FALSE(batch(2).run(poses, {.max_contacts = 8}, answers).has_value());
  std::size_t contacts = 0;
  for (const BatchAnswer& answer : answers) contacts += answer.contacts;
  EXPECT_GT(contacts, 100U);
}

TEST_F(BatchTest, NoPosesHaveNoAnswers) { EXPECT_FALSE(batch(3).run({}, {}, {}).has_value()); }

TEST_F(BatchTest, APoseThatCannotBeUsedIsUndecided) {
  poses[3].translation.x() = std::numeric_limits<double>::quiet_NaN();
  std::vector<BatchAnswer> answers(poses.size());
  ASSERT_FALSE(batch(2).run(poses, {}, answers).has_value());
  EXPECT_EQ(answers[3].basis, Basis::budget);
  EXPECT_EQ(answers[3].probability, 0.5);
  EXPECT_EQ(answers[3].contacts, 0U);
  EXPECT_EQ(answers[4].basis, Basis::proved);
}

TEST_F(BatchTest, RefusesPlacesOfAnotherNumber) {
  BatchAnswer untouched;
  untouched.probability = 7.0;
  std::vector<BatchAnswer> answers(poses.size() - 1, untouched);
  Batch some = batch(1);
  ASSERT_TRUE(some.run(poses, {}, answers).has_value());
  EXPECT_EQ(answers[0].probability, 7.0);
  answers.emplace_back();
  std::vector<Contact> contacts(2 * poses.size());
  EXPECT_TRUE(some.run(poses, {.max_contacts = 3}, answers, contacts).has_value());
  EXPECT_TRUE(some.run(poses, {.max_contacts = 1}, answers, contacts).has_value());
  EXPECT_EQ(answers[0].probability, 7.0);
  EXPECT_FALSE(some.run(poses, {.max_contacts = 2}, answers, contacts).has_value());
}

TEST_F(BatchTest, RefusesWhatAPairRefuses) {
  EXPECT_FALSE(Batch::make(a, nullptr).ok());
  EXPECT_FALSE(Batch::make(a, b, {.hit_capacity = 1}).ok());
  EXPECT_FALSE(Batch::make(a, b, {}, 2000).ok());
  EXPECT_GE(Batch::make(a, b).value().threads(), 1U);
}

}  // namespace
}  // namespace odds::query
