// ANSWERS.csv: one row for each answer of `odds query`.
#pragma once

#include <string>
#include <string_view>

#include "odds/query/answer.hpp"

namespace odds::tool {

/// An answer that outlives its pair's next run, with the wall time measured around it.
struct AnswerRecord {
  query::Answer answer;      ///< its span of contacts is empty; the first contact stands below
  std::size_t contacts = 0;  ///< how many there were
  query::Contact contact;    ///< the first, in A's frame, if there was one
  double wall_us = 0.0;      ///< one query alone

  AnswerRecord() = default;
  AnswerRecord(const query::Answer& given, double measured_us);
};

inline constexpr std::string_view answers_header =
    "row,verdict,basis,probability,node_pairs,triangle_pairs,wall_us,stall_us,contacts,px,py,pz,nx,ny,nz,depth\n";

/// One line. Coordinates and probability are the shortest decimals that read back to the same doubles; metres,
/// microseconds.
std::string answer_line(std::size_t row, const AnswerRecord& record);

}  // namespace odds::tool
