/* Budgeted mesh collision for programs that use ODE: one geom class, C interface in ODE's own style. C99 and C++. */
#ifndef ODDS_ODE_H
#define ODDS_ODE_H

#include <ode/ode.h>
#include <stddef.h>

#ifdef __cplusplus
#define ODDS_NOTHROW noexcept
extern "C" {
#else
#define ODDS_NOTHROW
#endif

/* ---- General rules ------------------------------------------------------------------------------------------------
 * Lengths in metres, times in microseconds, poses and contacts in ODE's world frame, meshes in their own frame (the
 * geom's frame). Triangles are counter-clockwise seen from outside.
 * Functions that can fail return 0 (or a null id) and leave a sentence in oddsGetLastError().
 * A geom argument that is not a live geom of this class is the caller's error and is treated the same way: the function
 * does nothing, returns 0, and says so in oddsGetLastError().
 * Threads: set-up functions (init, close, build, create, destroy, prepare, setters) must not run while another thread
 * collides the same geoms. dCollide itself may run in several threads at once on different pairs whose poses are clean
 * (call dSpaceClean or dGeomGetAABB before); the same pair in two threads at once is refused, with 0 contacts, and
 * counted. */

/* ---- Library --------------------------------------------------------------------------------------------------- */

/* Initialises ODE (dInitODE2(flags), data for the calling thread) and registers the one geom class. Counted: every
 * successful call needs one oddsCloseODE. As long as the count is above 0, ODE stays initialised, whatever pairs of
 * dInitODE/dCloseODE the program runs in between. Returns 1, or 0 if ODE refused. At most four user classes fit in a
 * process; ODE itself aborts at the fifth, this library always takes one. */
int oddsInitODE(unsigned flags) ODDS_NOTHROW;

/* Gives back one oddsInitODE. Destroy all geoms of the class before the last one. */
void oddsCloseODE(void) ODDS_NOTHROW;

/* The class number (dGeomGetClass of every geom made here), or -1 while not initialised. */
int oddsGetClass(void) ODDS_NOTHROW;

/* What went wrong in the last failed call of this thread; never null, "" if nothing did. Valid until the next failure.
 */
const char* oddsGetLastError(void) ODDS_NOTHROW;

/* ---- Mesh data ------------------------------------------------------------------------------------------------- */

typedef struct oddsMeshData* oddsMeshDataID;

enum {
  ODDS_VOLUME_AABB = 0, /* axis-aligned boxes */
  ODDS_VOLUME_OBB = 1,  /* oriented boxes */
  ODDS_VOLUME_SPHERE = 2,
  ODDS_VOLUME_KDOP14 = 3, /* slabs along 7 fixed directions */
  ODDS_VOLUME_KDOP18 = 4, /* 9 */
  ODDS_VOLUME_KDOP26 = 5, /* 13 */
  ODDS_VOLUME_HULL = 6,   /* convex hulls of at most 32 corners: least pairs, most time and memory for each */
  ODDS_VOLUME_WIDE = 7    /* the wide engine: boxes cut by slabs, eight tested at once (default) */
};

typedef struct oddsBuildParams {
  int volume;         /* ODDS_VOLUME_...; two meshes that meet must have the same one */
  int leaf_triangles; /* most triangles in a leaf, 1 .. 16 (wide: 8); 0: what suits the volume (default) */
  double tau;         /* filling from which a cell counts, in (0, 1] */
  const char* name;   /* stands in error messages; may be null */
} oddsBuildParams;

/* Fills in the defaults: the wide engine, as many triangles as suit it, tau 0.25, no name. */
void oddsBuildParamsInit(oddsBuildParams* params) ODDS_NOTHROW;

/* An empty container. Build once, share among any number of geoms. */
oddsMeshDataID oddsMeshDataCreate(void) ODDS_NOTHROW;
/* Frees the container. Geoms made from it keep what they need. Null is allowed. */
void oddsMeshDataDestroy(oddsMeshDataID data) ODDS_NOTHROW;

/* Copies an indexed mesh and builds its hierarchy (allocates, takes time: before the loop). Strides are in bytes;
 * `index_count` is three times the number of triangles. `params` may be null (defaults). A rebuilt container does not
 * change geoms that exist. Returns 1, or 0 with an error (index out of range, coordinate not finite, bad parameter
 * ...); then the container keeps what it had. */
int oddsMeshDataBuildDouble(oddsMeshDataID data, const double* vertices, int vertex_stride, int vertex_count,
                            const dTriIndex* indices, int index_count, int triangle_stride,
                            const oddsBuildParams* params) ODDS_NOTHROW;
int oddsMeshDataBuildSingle(oddsMeshDataID data, const float* vertices, int vertex_stride, int vertex_count,
                            const dTriIndex* indices, int index_count, int triangle_stride,
                            const oddsBuildParams* params) ODDS_NOTHROW;

/* Adopts the triangles of an existing dTriMesh geom, in its mesh frame, triangle numbers kept. ODE gives them out
 * rounded to single precision; equal vertices are welded. The dTriMesh geom is not changed. */
int oddsMeshDataBuildFromTriMesh(oddsMeshDataID data, dGeomID trimesh, const oddsBuildParams* params) ODDS_NOTHROW;

/* The samples of an ODE heightfield, which ODE does not give out again. Its frame: x along the width, z along the
 * depth, both from -half to half, y up. `thickness` > 0 closes the ground below its lowest point, so that it is a
 * solid. */
typedef struct oddsHeightfield {
  dHeightfieldGetHeight* height; /* called once for each sample with x < width_samples, z < depth_samples */
  void* user;                    /* handed to it */
  double width;                  /* metres */
  double depth;
  int width_samples; /* 2 .. 8192 */
  int depth_samples;
  double scale; /* height in metres = sample * scale + offset */
  double offset;
  double thickness; /* metres, >= 0 */
} oddsHeightfield;
int oddsMeshDataBuildHeightfield(oddsMeshDataID data, const oddsHeightfield* field,
                                 const oddsBuildParams* params) ODDS_NOTHROW;

int oddsMeshDataGetTriangleCount(oddsMeshDataID data) ODDS_NOTHROW; /* 0 if not built */
/* 1 if every edge is matched by its opposite and something is enclosed (a solid: what is inside is pushed out), or 0. */
int oddsMeshDataIsClosed(oddsMeshDataID data) ODDS_NOTHROW;

/* ---- Geoms ----------------------------------------------------------------------------------------------------- */

/* A placeable geom of built data, put into `space` (may be null). Everything that works on a geom works on it: bodies,
 * offsets, category bits, dGeomTransform, all spaces. dGeomDestroy frees it and every pair workspace it takes part in.
 */
dGeomID dCreateOddsMesh(dSpaceID space, oddsMeshDataID data) ODDS_NOTHROW;

/* Settings. A pair of two such geoms uses the more careful of both settings, in either order of call:
 *   budgets: the smaller; maximum of contacts, carried motion: the smaller; p_min, k_min: the greater; method: exact
 *   before incremental before time-critical; estimator: cells if either asks for cells; undecided: no contact if either
 *   says so, else the greater probability.
 * Setters return 1, or 0 (value out of range, nothing changed). Getters of a wrong geom return 0. */

/* Wall time one collision may take, > 0; dInfinity: no limit. Default 100. */
int dGeomOddsMeshSetBudget(dGeomID geom, dReal microseconds) ODDS_NOTHROW;
dReal dGeomOddsMeshGetBudget(dGeomID geom) ODDS_NOTHROW;

/* Work one collision may do: pairs of nodes plus pairs of triangles. Same bits on every run if the budget in
 * microseconds is dInfinity. 0: no limit (default). */
int dGeomOddsMeshSetWorkBudget(dGeomID geom, unsigned long units) ODDS_NOTHROW;
unsigned long dGeomOddsMeshGetWorkBudget(dGeomID geom) ODDS_NOTHROW;

/* k_min pairs of nodes with probability >= p_min end a query with an estimated hit. p_min in (0, 1]; 1: never
 * (default). k_min >= 1 (default 10). */
int dGeomOddsMeshSetPMin(dGeomID geom, dReal p_min) ODDS_NOTHROW;
dReal dGeomOddsMeshGetPMin(dGeomID geom) ODDS_NOTHROW;
int dGeomOddsMeshSetKMin(dGeomID geom, int k_min) ODDS_NOTHROW;
int dGeomOddsMeshGetKMin(dGeomID geom) ODDS_NOTHROW;

/* Most contacts of one collision, 0 .. 8 (default 8; 0: ask only, oddsGetLastAnswer tells). The flags of dCollide and
 * this limit both hold. With 8, a ray gives every crossing that the caller has room for. */
int dGeomOddsMeshSetMaxContacts(dGeomID geom, int count) ODDS_NOTHROW;
int dGeomOddsMeshGetMaxContacts(dGeomID geom) ODDS_NOTHROW;

/* Contacts of a mesh with a mesh, box, cylinder or convex are carried along with the bodies instead of being made anew
 * while nothing near them has moved farther than this part of the smaller body's size, 0 .. 1, since they were made
 * with care: bodies at rest cost next to nothing, and their contacts stand still. A pair of triangles that still meets,
 * or a triangle that still is inside, proves the hit. Default 1e-5; 0: always made anew, and collisions with a box,
 * cylinder, capsule or convex that a budget ends keep nothing of earlier ones, nor do searches for what is nearest to a
 * sphere or capsule, or below a plane, start from where that was last. */
int dGeomOddsMeshSetCarryMotion(dGeomID geom, dReal part) ODDS_NOTHROW;
dReal dGeomOddsMeshGetCarryMotion(dGeomID geom) ODDS_NOTHROW;

/* 1 (default): where the budget is below 50 us, or below what a collision of this pair was seen to need, contacts of
 * two meshes are made over several collisions and carried along with the bodies: complete, but some steps late. Until
 * then they are guessed, and hardly deep. Bodies stand, and nothing is thrown. 0: made of what each collision has time
 * for: rougher, but as deep as the bodies, for fast things and contacts that are springs (an odds::ode::World has 0).
 * Of a pair: 1 only if it is set on both. */
int dGeomOddsMeshSetLateContacts(dGeomID geom, int on) ODDS_NOTHROW;
int dGeomOddsMeshGetLateContacts(dGeomID geom) ODDS_NOTHROW;

/* Two meshes that touched in the last collision keep their contacts while they are apart by no more than this, metres,
 * >= 0; of a pair the greater one holds. Default 0: none. Their depth is minus the gap. Hand every contact to
 * oddsMakeSpeculative, which lets bodies come nearer by the gap in a step and no faster (a speculative contact; ODE by itself
 * takes a negative depth for 0, and would hold bodies that far apart): what slides over a mesh under load is not dropped
 * for a tick wherever one of its contacts is lost by a nanometre. What bodies move in a few steps is enough. It widens
 * the geom's box, when the geom moves next; that of a dTriMesh is ODE's own. Two rays a contact that was lost, of the
 * budget that is left; not in an odds::ode::World, whose contacts are springs. */
int dGeomOddsMeshSetMargin(dGeomID geom, dReal metres) ODDS_NOTHROW;
dReal dGeomOddsMeshGetMargin(dGeomID geom) ODDS_NOTHROW;
/* For the near callback, before dJointCreateContact: if the contact's depth is negative, adds depth / step_s to its
 * motionN (dContactMotionN is set). Any other contact, a null one, or a step that is not > 0: nothing. Thread-safe. */
void oddsMakeSpeculative(dContact* contact, dReal step_s) ODDS_NOTHROW;

/* Of a pair: time-critical only if it is set on both. */
enum { ODDS_METHOD_EXACT = 0, ODDS_METHOD_INCREMENTAL = 1 /* default */, ODDS_METHOD_TIME_CRITICAL = 2 };
int dGeomOddsMeshSetMethod(dGeomID geom, int method) ODDS_NOTHROW;
int dGeomOddsMeshGetMethod(dGeomID geom) ODDS_NOTHROW;

enum { ODDS_ESTIMATOR_CELLS = 0, ODDS_ESTIMATOR_KINEMATIC = 1 /* default */ };
int dGeomOddsMeshSetEstimator(dGeomID geom, int estimator) ODDS_NOTHROW;
int dGeomOddsMeshGetEstimator(dGeomID geom) ODDS_NOTHROW;

/* What a query gives back that the budget ended before anything was proved:
 *   ODDS_UNDECIDED_HIT         one contact at the most probable pair of cells if the probability of a hit exceeds p
 *                              (0 <= p < 1; default policy, p = 0.5), or 0.6 p / (1 - 0.4 p), 0.6 of its odds, where the
 *                              query before gave a contact and did not prove them apart, or if the last query that was
 *                              decided, by proof or estimate, was a hit at most 16 queries ago and no point of the
 *                              smaller body has moved by more than half of its size since, else none;
 *   ODDS_UNDECIDED_NO_CONTACT  none (p is kept but not used). Nor are contacts kept of boxes, cylinders, capsules and
 *                              convexes for collisions that a budget ends.
 * The last answer says in each case what happened. */
enum { ODDS_UNDECIDED_HIT = 0, ODDS_UNDECIDED_NO_CONTACT = 1 };
int dGeomOddsMeshSetUndecidedPolicy(dGeomID geom, int policy, dReal p) ODDS_NOTHROW;
int dGeomOddsMeshGetUndecidedPolicy(dGeomID geom) ODDS_NOTHROW;
dReal dGeomOddsMeshGetUndecidedProbability(dGeomID geom) ODDS_NOTHROW;

/* ---- Partners of ODE's own classes ---------------------------------------------------------------------------------
 * Spheres, boxes, capsules, cylinders, planes and rays need nothing. A dTriMesh is read (in single precision, as ODE
 * keeps it) when its first pair is prepared, or else in its first dCollide, and counted (lazy_partners). Convexes and
 * heightfields must be made known. What is known about a geom must be forgotten before it is destroyed; a geom that is
 * no longer what was made known gives 0 contacts, and is counted (changed_partners). All are set-up functions; the last
 * oddsCloseODE forgets everything. Settings of a dTriMesh or heightfield that is known can be set like those of a geom
 * of this class; until then they leave every decision to the other geom. */

/* Reads a dTriMesh now, again if it was read before (its vertices were moved, other data were set). */
int oddsPrepareTriMesh(dGeomID trimesh, const oddsBuildParams* params) ODDS_NOTHROW;

/* Lets mesh data stand in for a dTriMesh (your own doubles instead of ODE's rounded ones) or a heightfield; `placeable`
 * is what dCreateHeightfield was given, and not used for a dTriMesh. */
int oddsSetStandIn(dGeomID geom, oddsMeshDataID data, int placeable) ODDS_NOTHROW;

/* Copies the points and polygons that dCreateConvex was given, or dGeomSetConvex since: then it has to be called again,
 * outside of callbacks, and renews ODE's box around the geom, which dGeomSetConvex leaves. Refused: what is not a convex
 * solid. */
int oddsRegisterConvex(dGeomID convex, const dReal* points, unsigned point_count, const unsigned* polygons,
                       unsigned polygon_count) ODDS_NOTHROW;

/* Call it before dGeomDestroy. 0 if nothing was known about the geom. */
int oddsForgetGeom(dGeomID geom) ODDS_NOTHROW;

/* ---- Pairs ----------------------------------------------------------------------------------------------------- */

/* Takes the memory that collisions between two meshes need, in either order, and warms it: up to 0.5 MB, less of small
 * meshes, and what pairs share, a megabyte for each pair up to 32 (or as many as the processor runs threads), and 3.7
 * MB for late contacts, also where they are off, for each pair up to 64. A mesh is a geom of this class, a dTriMesh, or
 * a heightfield with a stand-in. Call it before the loop for every pair that can meet in a dSpaceCollide. Returns 1
 * (also if already prepared, and for a pair of a mesh with a primitive, which needs no memory), or 0 (unlike volumes,
 * out of memory, no mesh). A pair that was not prepared is prepared at its first dCollide, inside the loop, and counted
 * (lazy_pairs); if that fails the collision returns 0 contacts and is counted (failed_pairs). */
int oddsPreparePair(dGeomID g1, dGeomID g2) ODDS_NOTHROW;

enum { ODDS_CLEAR = 0, ODDS_HIT = 1 };
enum { ODDS_PROVED = 0, ODDS_ESTIMATED = 1, ODDS_BUDGET = 2 };

/* What the last collision of a pair found out. World frame of that moment; g1 and g2 as given to oddsGetLastAnswer. */
typedef struct oddsAnswer {
  int verdict;                       /* ODDS_CLEAR or ODDS_HIT: the likelier one */
  int basis;                         /* ODDS_PROVED, ODDS_ESTIMATED, ODDS_BUDGET (ended by the budget) */
  double probability;                /* of a hit, 0 .. 1; exactly 0 or 1 where proved */
  int contacts;                      /* given back to ODE */
  int from_cell_pair;                /* 1 if the contact given back is the cell pair below */
  unsigned long long node_pairs;     /* pairs of bounding volumes tested */
  unsigned long long triangle_pairs; /* pairs of triangles tested, and triangles near another leaf */
  double gross_us;                   /* from start to return of the query */
  double stall_us;                   /* of these, not the query's own work (pre-emption) */
  double overshoot_us;               /* beyond the budget, >= 0 */
  double net_overshoot_us;           /* the same without stalls, >= 0 */
  int has_cell_pair;                 /* 1 if the following are set: where the surfaces most probably meet */
  double cell_probability;           /* of an intersection within that pair of cells */
  double cell_position[3];
  double cell_normal[3]; /* unit, into g1 */
  double cell_depth;     /* >= 0 */
  int bad_pose;          /* 1 if a pose was not finite or not rigid: no contacts, nothing tested */
  int only_held;         /* 1 if it was not this pair's turn in a frame (odds_frame.h): nothing tested, verdict and odds
                          * are those of before */
} oddsAnswer;

/* The last collision of a pair, in either order: of geoms of this class, of a dTriMesh that was read or has a stand-in,
 * of a heightfield with a stand-in. 0 with an error if a geom is none of these, or they never collided. Not while
 * another thread collides the same pair. */
int oddsGetLastAnswer(dGeomID g1, dGeomID g2, oddsAnswer* answer) ODDS_NOTHROW;

/* ---- Takeover --------------------------------------------------------------------------------------------------- */

/* Which collisions of a dTriMesh are taken over. */
enum {
  ODDS_TAKE_TRIMESH = 1, /* with another dTriMesh */
  ODDS_TAKE_SPHERE = 2,
  ODDS_TAKE_BOX = 4,
  ODDS_TAKE_CAPSULE = 8,
  ODDS_TAKE_CYLINDER = 16,
  ODDS_TAKE_PLANE = 32,
  ODDS_TAKE_RAY = 64,
  ODDS_TAKE_CONVEX = 128, /* with those that oddsRegisterConvex made known */
  ODDS_TAKE_ALL = 255
};

typedef struct oddsTakeOverParams {
  unsigned partners;        /* ODDS_TAKE_..., added up; default all */
  double budget_us;         /* of one collision, > 0; default 100 */
  unsigned long work_units; /* 0: no limit (default) */
  int max_contacts;         /* 0 .. 8; default 8 */
} oddsTakeOverParams;
void oddsTakeOverParamsInit(oddsTakeOverParams* params) ODDS_NOTHROW;

/* From now on dCollide answers for every dTriMesh, also those that exist, as it does for geoms of this class; nothing
 * in the client changes. A set-up function. It holds ODE initialised (as oddsInitODE does), so that pairs of dInitODE
 * and dCloseODE do not undo it; a program that closes ODE once too often must call it again after dInitODE. `params`
 * may be null (defaults); the settings hold for the geoms that become known from then on, a second call replaces those
 * of the first. A dTriMesh is read when it is prepared, or else at its first collision, and counted. Left to ODE's own
 * collider, and counted (fallbacks): a dTriMesh with a callback, one that cannot be read or was changed since, a convex
 * that was not made known. Returns 1, or 0 with an error. */
int oddsTakeOverTriMesh(const oddsTakeOverParams* params) ODDS_NOTHROW;

/* Puts ODE's own colliders back. 0 if nothing was taken over, or if this build of ODE hides its colliders. */
int oddsGiveBackTriMesh(void) ODDS_NOTHROW;

/* Counts since the start of the process or the last oddsResetStats, over all geoms and threads. */
typedef struct oddsStats {
  unsigned long long queries;        /* collisions between two geoms of this class */
  unsigned long long queries_proved; /* ... by basis of the answer */
  unsigned long long queries_estimated;
  unsigned long long queries_budget;
  unsigned long long contacts;           /* given back to ODE by these */
  unsigned long long cell_pair_contacts; /* ... of these, made from the most probable pair of cells */
  unsigned long long
      primitive_queries; /* collisions with planes, spheres, boxes, capsules, cylinders, rays, convexes */
  unsigned long long primitive_cut_off; /* ... of these, ended by their budget before all triangles were seen */
  unsigned long long unsupported;       /* collisions with geoms that were not made known, or changed: 0 contacts */
  unsigned long long lazy_pairs;        /* pairs prepared inside dCollide */
  unsigned long long failed_pairs;      /* collisions without a workspace (unlike volumes, out of memory) */
  unsigned long long busy_pairs;        /* collisions refused: the pair was in use by another thread */
  unsigned long long bad_poses;         /* collisions with a pose that was not finite or not rigid */
  unsigned long long caught;            /* exceptions stopped at the border (never seen; a defect if not 0) */
  unsigned long long live_geoms;        /* now, not reset */
  unsigned long long live_pairs;        /* workspaces now, not reset */
  unsigned long long lazy_partners;     /* dTriMesh geoms read inside dCollide */
  unsigned long long changed_partners;  /* collisions with a geom that is not what was made known */
  unsigned long long live_partners;     /* geoms of ODE's own classes that are known now, not reset */
  unsigned long long taken_over;        /* collisions of a dTriMesh answered by a takeover */
  unsigned long long fallbacks;         /* ... left to ODE's own collider */
} oddsStats;
void oddsGetStats(oddsStats* stats) ODDS_NOTHROW;
void oddsResetStats(void) ODDS_NOTHROW;

#ifdef __cplusplus
}
#endif
#endif
