/* Uses the C interface from C: the geom class registers, and a mesh that is none is refused with a reason. */
#include <odds/ode/odds_ode.h>
#include <stdio.h>

int main(void) {
  if (!oddsInitODE(0)) return 1;
  const int class_number = oddsGetClass();
  oddsMeshDataID data = oddsMeshDataCreate();
  const double vertices[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const dTriIndex out_of_range[3] = {0, 1, 3};
  const int refused =
      !oddsMeshDataBuildDouble(data, vertices, 3 * sizeof(double), 3, out_of_range, 3, 3 * sizeof(dTriIndex), 0);
  printf("ode: class %d; %s\n", class_number, oddsGetLastError());
  oddsMeshDataDestroy(data);
  oddsCloseODE();
  return class_number >= 0 && refused ? 0 : 2;
}
