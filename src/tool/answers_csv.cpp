#include "tool/answers_csv.hpp"

#include <fmt/format.h>

namespace odds::tool {

AnswerRecord::AnswerRecord(const query::Answer& given, double measured_us)
    : answer(given), contacts(given.contacts.size()), wall_us(measured_us) {
  if (contacts > 0) contact = given.contacts.front();
  answer.contacts = {};  // the pair's memory, overwritten by its next run
}

std::string answer_line(std::size_t row, const AnswerRecord& record) {
  const query::Answer& answer = record.answer;
  std::string line = fmt::format("{},{},{},{},{},{},{:.3f},{:.3f},{},", row, name(answer.verdict), name(answer.basis),
                                 answer.probability, answer.cost.node_pairs, answer.cost.triangle_pairs, record.wall_us,
                                 answer.cost.stall_us, record.contacts);
  if (record.contacts == 0) return line + ",,,,,,\n";
  const query::Contact& c = record.contact;
  return line + fmt::format("{},{},{},{},{},{},{}\n", c.position.x(), c.position.y(), c.position.z(), c.normal.x(),
                            c.normal.y(), c.normal.z(), c.depth);
}

}  // namespace odds::tool
