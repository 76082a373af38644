// Putting a text into its file, whole or not at all.
#pragma once

#include "mesh/output_file.hpp"

namespace odds::report {

using mesh::write_file;

}  // namespace odds::report
