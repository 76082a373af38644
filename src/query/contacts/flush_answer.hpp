// Flat faces that lie on each other, as what a run answers with: learnt from what it finds, and written.
#pragma once

#include <span>

#include "query/contacts/rough_contacts.hpp"
#include "query/memory/pair_memory.hpp"
#include "query/posed_meshes.hpp"
#include "query/spending.hpp"

namespace odds::query {

/// Budgets of less have time for contacts of flat faces, but none that is left for anything else.
inline constexpr double very_short_us = 3.0;

/// Whether a crossing is where faces lie on each other that are known, or are found now.
[[nodiscard]] bool is_of_flat_faces(const PosedMeshes& meshes, const Crossing& crossing,
                                    Pair::Implementation& pair) noexcept;

/// What is known of faces that lie on each other, as they lie now. `measured`: by a patch of all there is.
void move_flush(const math::Pose& pose_b_in_a, bool measured, Pair::Implementation& pair, Spending& spending) noexcept;

/// Whether the pair's hits are where faces lie on each other; some of them are looked at, from all over their list.
[[nodiscard]] bool see_flush(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept;

/// Whether the contacts that a patch has made, at `pose`, are all where faces lie on each other. `all`: of all there
/// is. Without the time to look at all of them: as far as was looked, and those before were.
[[nodiscard]] bool is_all_flush(std::span<const Contact> contacts, const math::Pose& pose, bool all,
                                Pair::Implementation& pair, Spending& spending) noexcept;

/// Places where the bodies meet that the work under way has found: faces that lie on each other there are known before
/// it ends, and so is whatever else touches.
void learn_from_work(const PosedMeshes& meshes, Pair::Implementation& pair, Spending& spending) noexcept;

/// Their contacts are the answer. `all`: nothing else touches now.
void write_flush(const PosedMeshes& meshes, bool all, const Request& request, Pair::Implementation& pair,
                 Spending& spending) noexcept;

/// Their contacts beside those of the answer: they hold also where the bodies touch elsewhere, and nothing is known
/// there but a guess.
void add_flush(const Request& request, Pair::Implementation& pair, Spending& spending) noexcept;

/// Their contacts in place of those of the patch that is the pair's answer, if that has found nothing else. False: the
/// patch's remain.
[[nodiscard]] bool answer_by_flat_faces(const PosedMeshes& meshes, const math::Pose& pose_b_in_a,
                                        const Request& request, Pair::Implementation& pair,
                                        Spending& spending) noexcept;

/// After a search that its budget has ended without a hit: where they overlap, the surfaces meet, and have contacts if
/// there is time; a guess beside such faces has their normal.
void judge_by_flat_faces(const PosedMeshes& meshes, const Request& request, Pair::Implementation& pair,
                         Spending& spending) noexcept;

}  // namespace odds::query
