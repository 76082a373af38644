// ODE's own functions behind those that this library puts in front of them.
#pragma once

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

namespace odds::preload {

/// The next definition of `name` in the order of loading: ODE's. A program that has no ODE cannot have called us.
template <class Function>
[[nodiscard]] Function* real(const char* name) noexcept {
  auto* found = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
  if (found == nullptr) {
    std::fprintf(stderr, "error: libodds_preload: %s is not in a shared library of ODE; link the program against one\n",
                 name);
    std::abort();
  }
  return found;
}

}  // namespace odds::preload
