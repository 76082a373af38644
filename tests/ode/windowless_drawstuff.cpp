// ODE's demonstrations without a window: runs DS_FRAMES frames (300) and presses the keys of DS_KEYS, one every fifth
// frame. Built by tests/ode/odes_tests only, against the drawstuff.h of ODE's source package.
#include <drawstuff/drawstuff.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {

void dsSimulationLoop(int, char**, int, int, dsFunctions* demo) {
  const char* frames_text = std::getenv("DS_FRAMES");
  const int frames = frames_text != nullptr ? std::atoi(frames_text) : 300;
  const char* keys = std::getenv("DS_KEYS");
  const int key_count = keys != nullptr ? static_cast<int>(std::strlen(keys)) : 0;
  if (demo->start != nullptr) demo->start();
  for (int frame = 0; frame < frames; ++frame) {
    if (key_count > 0 && frame % 5 == 0 && demo->command != nullptr) demo->command(keys[frame / 5 % key_count]);
    if (demo->step != nullptr) demo->step(0);
  }
  if (demo->stop != nullptr) demo->stop();
  std::printf("ran %d frames\n", frames);
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
void dsDrawBox(const float*, const float*, const float*) {}
void dsDrawSphere(const float*, const float*, float) {}
void dsDrawTriangle(const float*, const float*, const float*, const float*, const float*, int) {}
void dsDrawTriangles(const float*, const float*, const float*, int, int) {}
void dsDrawCylinder(const float*, const float*, float, float) {}
void dsDrawCapsule(const float*, const float*, float, float) {}
void dsDrawLine(const float*, const float*) {}
void dsDrawConvex(const float*, const float*, const float*, unsigned, const float*, unsigned, const unsigned*) {}
void dsDrawBoxD(const double*, const double*, const double*) {}
void dsDrawSphereD(const double*, const double*, const float) {}
void dsDrawTriangleD(const double*, const double*, const double*, const double*, const double*, int) {}
void dsDrawTrianglesD(const double*, const double*, const double*, int, int) {}
void dsDrawCylinderD(const double*, const double*, float, float) {}
void dsDrawCapsuleD(const double*, const double*, float, float) {}
void dsDrawLineD(const double*, const double*) {}
void dsDrawConvexD(const double*, const double*, const double*, unsigned, const double*, unsigned, const unsigned*) {}
void dsSetSphereQuality(int) {}
void dsSetCapsuleQuality(int) {}
void dsSetDrawMode(int) {}

}  // extern "C"
