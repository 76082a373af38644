// ODE's demonstrations without a window: runs DS_FRAMES frames (300), presses the keys of DS_KEYS, one every fifth
// frame, and ends with a line on the frames' times and on what the last frame drew. Built by tests/ode/odes_tests only,
// against the drawstuff.h of ODE's source package.
#include <drawstuff/drawstuff.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <vector>

namespace {

/// Where the last frame drew something: a mesh counts once, for all its triangles have one position.
struct LastFrame {
  bool is_now = false;
  std::set<std::array<double, 3>> places;
  int not_finite = 0;
} last_frame;

template <typename Real>
void drawn(const Real* position) {
  if (!last_frame.is_now) return;
  const std::array<double, 3> place = {static_cast<double>(position[0]), static_cast<double>(position[1]),
                                       static_cast<double>(position[2])};
  if (std::all_of(place.begin(), place.end(), [](double x) { return std::isfinite(x); })) {
    last_frame.places.insert(place);
  } else {
    ++last_frame.not_finite;
  }
}

void tell(std::vector<double>& frames_us) {
  std::sort(frames_us.begin(), frames_us.end());
  const auto at = [&](std::size_t percent) { return frames_us[(frames_us.size() - 1) * percent / 100]; };
  // All demos have their ground at or above 0.
  const auto fallen = std::count_if(last_frame.places.begin(), last_frame.places.end(),
                                    [](const std::array<double, 3>& place) { return place[2] < -0.5; });
  std::printf(
      "%zu frames: p50 %.1f us, p99 %.1f us, longest %.1f us; drawn last: %zu things, %ld below the ground, %d not "
      "finite\n",
      frames_us.size(), at(50), at(99), frames_us.back(), last_frame.places.size(), static_cast<long>(fallen),
      last_frame.not_finite);
}

}  // namespace

extern "C" {

void dsSimulationLoop(int, char**, int, int, dsFunctions* demo) {
  const char* frames_text = std::getenv("DS_FRAMES");
  const int frames = frames_text != nullptr ? std::atoi(frames_text) : 300;
  const char* keys = std::getenv("DS_KEYS");
  const int key_count = keys != nullptr ? static_cast<int>(std::strlen(keys)) : 0;
  if (demo->start != nullptr) demo->start();
  std::vector<double> frames_us;
  for (int frame = 0; frame < frames; ++frame) {
    if (key_count > 0 && frame % 5 == 0 && demo->command != nullptr) demo->command(keys[frame / 5 % key_count]);
    last_frame.is_now = frame + 1 == frames;
    const auto start = std::chrono::steady_clock::now();
    if (demo->step != nullptr) demo->step(0);
    frames_us.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }
  if (!frames_us.empty()) tell(frames_us);
  if (demo->stop != nullptr) demo->stop();
}

void dsError(const char* message, ...) {
  std::fprintf(stderr, "%s\n", message);
  std::exit(1);
}
void dsDebug(const char* message, ...) {
  std::fprintf(stderr, "%s\n", message);
  std::abort();
}
void dsPrint(const char*, ...) {}
void dsSetViewpoint(float*, float*) {}
void dsGetViewpoint(float* xyz, float* hpr) {
  for (int axis = 0; axis < 3; ++axis) xyz[axis] = hpr[axis] = 0.0f;
}
void dsStop() {}
double dsElapsedTime() { return 0.01; }
void dsSetTexture(int) {}
void dsSetColor(float, float, float) {}
void dsSetColorAlpha(float, float, float, float) {}
void dsDrawBox(const float* position, const float*, const float*) { drawn(position); }
void dsDrawSphere(const float* position, const float*, float) { drawn(position); }
void dsDrawTriangle(const float* position, const float*, const float*, const float*, const float*, int) {
  drawn(position);
}
void dsDrawTriangles(const float* position, const float*, const float*, int, int) { drawn(position); }
void dsDrawCylinder(const float* position, const float*, float, float) { drawn(position); }
void dsDrawCapsule(const float* position, const float*, float, float) { drawn(position); }
void dsDrawLine(const float*, const float*) {}
void dsDrawConvex(const float* position, const float*, const float*, unsigned, const float*, unsigned,
                  const unsigned*) {
  drawn(position);
}
void dsDrawBoxD(const double* position, const double*, const double*) { drawn(position); }
void dsDrawSphereD(const double* position, const double*, const float) { drawn(position); }
void dsDrawTriangleD(const double* position, const double*, const double*, const double*, const double*, int) {
  drawn(position);
}
void dsDrawTrianglesD(const double* position, const double*, const double*, int, int) { drawn(position); }
void dsDrawCylinderD(const double* position, const double*, float, float) { drawn(position); }
void dsDrawCapsuleD(const double* position, const double*, float, float) { drawn(position); }
void dsDrawLineD(const double*, const double*) {}
void dsDrawConvexD(const double* position, const double*, const double*, unsigned, const double*, unsigned,
                   const unsigned*) {
  drawn(position);
}
void dsSetSphereQuality(int) {}
void dsSetCapsuleQuality(int) {}
void dsSetDrawMode(int) {}

}  // extern "C"
