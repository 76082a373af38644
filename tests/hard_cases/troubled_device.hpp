// A device from outside of the library that fails on purpose.
#pragma once

namespace odds::hard_cases {

/// Registers the type "troubled": follows a script; `trouble` is "silent" (no state from 0.45 s to 0.55 s, refuses the
/// command at 0.9 s) or "nan" (every seventh state is not finite).
void register_troubled_device();

}  // namespace odds::hard_cases
