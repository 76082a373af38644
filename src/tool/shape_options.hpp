// Options that several sub-commands share: how a mesh is made ready, and checks of numbers.
#pragma once

#include <CLI/CLI.hpp>

#include "odds/query/shape.hpp"

namespace odds::tool {

/// Adds --bv and --tau.
void add_shape_options(CLI::App& command, query::ShapeOptions& options);

/// Accepts finite numbers > 0.
CLI::Validator positive_and_finite();
/// Accepts numbers in (0, 1].
CLI::Validator share_of_one();

}  // namespace odds::tool
