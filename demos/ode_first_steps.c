/* A crate falls on another crate, both triangle meshes, in a plain ODE program written in C. */
#include <odds/ode/odds_ode.h>
#include <stdio.h>

static const double corners[8][3] = {{-.5, -.5, -.5}, {.5, -.5, -.5}, {.5, .5, -.5}, {-.5, .5, -.5},
                                     {-.5, -.5, .5},  {.5, -.5, .5},  {.5, .5, .5},  {-.5, .5, .5}};
static const dTriIndex faces[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                       {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
static dWorldID world;
static dJointGroupID contact_joints;

static void near_callback(void* data, dGeomID a, dGeomID b) {
  (void)data;
  dContact contacts[8];
  const int count = dCollide(a, b, 8, &contacts[0].geom, sizeof(dContact));
  for (int i = 0; i < count; ++i) {
    contacts[i].surface.mode = dContactApprox1;
    contacts[i].surface.mu = 0.6;
    dJointID joint = dJointCreateContact(world, contact_joints, &contacts[i]);
    dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
  }
}

int main(void) {
  /* Instead of dInitODE: also registers the geom class. */
  if (!oddsInitODE(0)) return fprintf(stderr, "error: %s\n", oddsGetLastError()), 1;
  world = dWorldCreate();
  dWorldSetGravity(world, 0, 0, -9.81);
  contact_joints = dJointGroupCreate(0);
  dSpaceID space = dHashSpaceCreate(0);

  oddsMeshDataID crate = oddsMeshDataCreate();
  if (!oddsMeshDataBuildDouble(crate, &corners[0][0], 3 * sizeof(double), 8, &faces[0][0], 36, 3 * sizeof(dTriIndex), 0))
    return fprintf(stderr, "error: %s\n", oddsGetLastError()), 1;

  dGeomID below = dCreateOddsMesh(space, crate); /* no body: it stands still */
  dGeomID above = dCreateOddsMesh(space, crate);
  dBodyID body = dBodyCreate(world);
  dMass mass;
  dMassSetBox(&mass, 400.0, 1.0, 1.0, 1.0);
  dBodySetMass(body, &mass);
  dGeomSetBody(above, body);
  dBodySetPosition(body, 0.1, 0.05, 1.2);

  dGeomOddsMeshSetBudget(above, 200.0); /* microseconds one collision may take */
  oddsPreparePair(below, above);       /* takes the memory now, not inside the loop */

  for (int step = 0; step < 1000; ++step) {
    dSpaceCollide(space, 0, near_callback);
    dWorldQuickStep(world, 0.001);
    dJointGroupEmpty(contact_joints);
  }

  oddsAnswer answer;
  oddsGetLastAnswer(below, above, &answer);
  const double height = dBodyGetPosition(body)[2];
  printf("the crate rests at %.3f m; last answer: P(hit) = %.3f, %d contacts, %.1f us\n", height, answer.probability,
         answer.contacts, answer.gross_us);

  dGeomDestroy(above);
  dGeomDestroy(below);
  oddsMeshDataDestroy(crate);
  dJointGroupDestroy(contact_joints);
  dSpaceDestroy(space);
  dWorldDestroy(world);
  oddsCloseODE();
  return height > 0.98 && height < 1.02 ? 0 : 1; /* it also runs as a test */
}
