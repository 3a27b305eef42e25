/* libbrainshift in C: how the brain moves when cerebrospinal fluid (CSF) is lost.
 *
 * Units: mm, kg, s; hence force mN, stress kPa, energy uJ, density kg/mm^3; 1 mL = 1000 mm^3.
 * Arrays: row-major float64 and int32, as numpy and VTK hold them. Arrays passed in are read during
 * the call only and need no alignment. Counts are rows, 0 <= count < 2^31; NULL goes with count 0.
 *
 * Status: negative: refused or failed, nothing has changed. 0: done. Positive: done, with a remark.
 * brs_context_message() says the same in a sentence. Every function may return BRS_ERROR_NULL,
 * _HANDLE, _BUSY or _MEMORY; the others are listed with it.
 *
 * Handles: the caller owns what *_create returns (set to NULL on failure) and destroys it in any
 * order; destroying NULL is fine. Meshes, surfaces and snapshots never change and may be used from
 * other contexts and threads. A handle of the wrong type is refused; using a destroyed handle is
 * undefined. A call reports to the context of its first handle; where that is NULL, no message is
 * kept.
 *
 * Threads: one call at a time per context, BRS_ERROR_BUSY otherwise (so from a callback too);
 * contexts are independent of each other. Only brs_context_set_cancel() may come at any time.
 *
 * Structs begin with struct_size, and grow at the end only. Call the struct's _init first, with
 * sizeof of the struct; what an older header does not know keeps its default.
 */
#ifndef BRAINSHIFT_C_BRAINSHIFT_H
#define BRAINSHIFT_C_BRAINSHIFT_H

#include <stdint.h>

#if defined(__GNUC__)
#define BRS_API __attribute__((visibility("default")))
#else
#define BRS_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- version ------------------------------------------------------------------------------- */

#define BRS_VERSION_MAJOR 0
#define BRS_VERSION_MINOR 1
#define BRS_VERSION_PATCH 0
#define BRS_VERSION (BRS_VERSION_MAJOR * 1000000 + BRS_VERSION_MINOR * 1000 + BRS_VERSION_PATCH)

/* BRS_VERSION of the library that runs, and the same as text: "0.1.0". */
BRS_API int32_t brs_version(void);
BRS_API const char* brs_version_string(void);
/* What the library was built with, and the licence that holds for the whole of it. */
BRS_API const char* brs_build_info(void);

/* ---- status -------------------------------------------------------------------------------- */

typedef int32_t brs_status;

enum {
  BRS_OK = 0,
  /* remarks */
  BRS_NOT_CONVERGED = 1,  /* iterations ran out; the state is the one before the solve */
  BRS_NO_EQUILIBRIUM = 2, /* no balance of forces was found; the state is the one before */
  BRS_CANCELLED = 3,      /* the host asked to stop; the state is the one before the solve */
  BRS_OUTSIDE = 4,        /* some points lie outside the mesh; their rows are NaN */
  /* misuse of this interface */
  BRS_ERROR_NULL = -1,        /* a NULL handle, array or result */
  BRS_ERROR_HANDLE = -2,      /* a handle of another type */
  BRS_ERROR_SIZE = -3,        /* a count below 0 or beyond 2^31 - 1 */
  BRS_ERROR_STRUCT_SIZE = -4, /* struct_size of no known version: was _init called? */
  BRS_ERROR_BUSY = -5,        /* the context is in another call */
  BRS_ERROR_MEMORY = -6,
  BRS_ERROR_VERSION = -7,  /* header and library do not go together */
  BRS_ERROR_CALLBACK = -8, /* the callback let an exception out */
  BRS_ERROR_INTERNAL = -9, /* a promise of the library is broken: please report */
  /* what the library found wrong with the input */
  BRS_ERROR_INVALID_ARGUMENT = -20,
  BRS_ERROR_EMPTY = -21,
  BRS_ERROR_SIZE_MISMATCH = -22,
  BRS_ERROR_INDEX_OUT_OF_RANGE = -23,
  BRS_ERROR_NOT_FINITE = -24,
  BRS_ERROR_INVERTED_ELEMENT = -25,
  BRS_ERROR_DEGENERATE_ELEMENT = -26,
  BRS_ERROR_DUPLICATE_ELEMENT = -27,
  BRS_ERROR_ORPHAN_NODE = -28,
  BRS_ERROR_SURFACE_NOT_CLOSED = -29,
  BRS_ERROR_INITIAL_PENETRATION = -30,
  BRS_ERROR_CONFLICTING_CONSTRAINTS = -31,
  BRS_ERROR_RIGID_MODE = -32,
  BRS_ERROR_FLUID_VOLUME = -33,
  BRS_ERROR_LINEAR_SOLVER = -34,
  BRS_ERROR_FILE = -35
};

/* "BRS_OK" and so on; "unknown status" for any other number. */
BRS_API const char* brs_status_name(brs_status status);

/* ---- context: messages, progress, cancel ----------------------------------------------------- */

typedef struct brs_context brs_context;

/* header_version: BRS_VERSION. BRS_ERROR_VERSION if that header does not go with this library:
 * another major version, another minor one before 1.0, or a header newer than the library. */
BRS_API brs_status brs_context_create(int32_t header_version, brs_context** context);
/* Other handles of the context stay usable. */
BRS_API brs_status brs_context_destroy(brs_context* context);

/* What the last call had to say, one sentence; "" after BRS_OK. Valid until the next call in the
 * context; callable from the thread that made the call, and from a callback. Never NULL. */
BRS_API const char* brs_context_message(const brs_context* context);

typedef struct brs_progress {
  int64_t struct_size;
  double load_factor; /* 0..1, part of the change of load that is being balanced */
  int64_t iteration;  /* Newton iterations so far in this solve */
  double residual;    /* relative */
} brs_progress;

/* Non-zero ends the solve with BRS_CANCELLED. Every call into the same context is refused with
 * BRS_ERROR_BUSY, messages and cancel apart. Do not longjmp out. */
typedef int32_t (*brs_progress_fn)(const brs_progress* progress, void* user);

/* Called after every Newton iteration of any solve in the context; NULL: no callback. */
BRS_API brs_status brs_context_set_progress(brs_context* context, brs_progress_fn progress,
                                            void* user);
/* While set (non-zero), solves end with BRS_CANCELLED after their next Newton iteration. It stays
 * set until it is withdrawn (0). May be called from any thread at any time; never busy. */
BRS_API brs_status brs_context_set_cancel(brs_context* context, int32_t cancel);

/* ---- mesh ------------------------------------------------------------------------------------ */

typedef struct brs_mesh brs_mesh;

/* nodes: node_count x 3, mm. tets: tet_count x 4 nodes, (p1-p0) x (p2-p0) . (p3-p0) > 0; orient:
 * non-zero turns those of negative volume instead of refusing them. regions: tet_count labels, or
 * NULL for all 0. Errors name the first culprit: EMPTY, NOT_FINITE, INDEX_OUT_OF_RANGE,
 * INVERTED_ELEMENT, DEGENERATE_ELEMENT, DUPLICATE_ELEMENT, ORPHAN_NODE, SIZE. */
BRS_API brs_status brs_mesh_create(brs_context* context, const double* nodes, int64_t node_count,
                                   const int32_t* tets, int64_t tet_count, const int32_t* regions,
                                   int32_t orient, brs_mesh** mesh);
BRS_API brs_status brs_mesh_destroy(brs_mesh* mesh);

/* Boundary faces, count x 3 nodes, outward. Valid as long as the mesh. */
BRS_API brs_status brs_mesh_surface(brs_mesh* mesh, const int32_t** triangles, int64_t* count);
/* Rows of the surface that belong to tets of `region`, without those whose nodes are all among
 * `dry_nodes` (a cut, a seam, a base), ascending. *count: how many there are; the first `capacity`
 * of them are written to `faces`. INDEX_OUT_OF_RANGE, SIZE. */
BRS_API brs_status brs_mesh_faces(brs_mesh* mesh, int32_t region, const int32_t* dry_nodes,
                                  int64_t dry_count, int32_t* faces, int64_t capacity,
                                  int64_t* count);

/* ---- rigid obstacle surfaces: skull, tentorium, falx ------------------------------------------- */

typedef struct brs_surface brs_surface;

enum {
  BRS_SURFACE_CAVITY = 0, /* closed, triangles outward; positive side: inside */
  BRS_SURFACE_SHEET = 1   /* open, two-sided; positive side: where its normals point */
};

typedef struct brs_surface_options {
  int64_t struct_size;
  double grid_spacing; /* mm, 2.5; edge of the distance grid: smaller features are rounded off */
  double band;         /* mm, 25; the distance is exact to the grid within this of the surface */
} brs_surface_options;

BRS_API brs_status brs_surface_options_init(brs_surface_options* options, int64_t struct_size);

/* points: point_count x 3, mm. triangles: triangle_count x 3. options: NULL for the defaults.
 * SURFACE_NOT_CLOSED, DEGENERATE_ELEMENT, INDEX_OUT_OF_RANGE, NOT_FINITE, INVALID_ARGUMENT, SIZE. */
BRS_API brs_status brs_surface_create(brs_context* context, int32_t kind, const double* points,
                                      int64_t point_count, const int32_t* triangles,
                                      int64_t triangle_count, const brs_surface_options* options,
                                      brs_surface** surface);
BRS_API brs_status brs_surface_destroy(brs_surface* surface);
/* distances: count, mm, signed, at the points (count x 3, mm). SIZE, NOT_FINITE. */
BRS_API brs_status brs_surface_distance(brs_surface* surface, const double* points, int64_t count,
                                        double* distances);

/* ---- scene: what a stepper is made from -------------------------------------------------------- */

typedef struct brs_scene brs_scene;

/* Without CSF and constraints, gravity (0, 0, -9810) mm/s^2, balanced reference. */
BRS_API brs_status brs_scene_create(brs_context* context, brs_mesh* mesh, brs_scene** scene);
BRS_API brs_status brs_scene_destroy(brs_scene* scene);

typedef struct brs_material {
  int64_t struct_size;
  const char* law; /* "linear", "corotational", "st_venant_kirchhoff", "stable_neo_hookean",
                      "log_neo_hookean" */
  double young;    /* kPa, > 0 */
  double poisson;  /* -1 < poisson < 0.5 */
  double density;  /* kg/mm^3, >= 0 */
} brs_material;

/* Law NULL, numbers NaN: all of them must be given. */
BRS_API brs_status brs_material_init(brs_material* material, int64_t struct_size);
/* Every region of the mesh needs one; a second replaces the first. INVALID_ARGUMENT, NOT_FINITE. */
BRS_API brs_status brs_scene_set_material(brs_scene* scene, int32_t region,
                                          const brs_material* material);
/* gravity: 3 numbers, mm/s^2. NOT_FINITE. */
BRS_API brs_status brs_scene_set_gravity(brs_scene* scene, const double* gravity);
/* Non-zero: the mesh is an image taken under gravity and full CSF, in balance with them, and loads
 * are differences from that. 0: the mesh is free of load; gravity and CSF act in full. */
BRS_API brs_status brs_scene_set_balanced_reference(brs_scene* scene, int32_t balanced);

enum {
  BRS_CSF_SEPARATE = 0,     /* each compartment has its own level; one that is closed stays full */
  BRS_CSF_COMMUNICATING = 1 /* one level for all; closed compartments may be under suction */
};

/* density: kg/mm^3, > 0. model: above. reference_head: level of the full fluid, mm along -gravity
 * from the origin; NaN: the top of the highest wall. Needs a compartment. INVALID_ARGUMENT. */
BRS_API brs_status brs_scene_set_csf(brs_scene* scene, double density, int32_t model,
                                     double reference_head);

typedef struct brs_compartment {
  int64_t struct_size;
  const char* name;
  const double* wall_points; /* closed rigid wall around tissue, fluid and air: count x 3, mm */
  int64_t wall_point_count;
  const int32_t* wall_triangles; /* count x 3, outward */
  int64_t wall_triangle_count;
  const int32_t* body_faces; /* rows of the mesh surface: closed surface of the tissue inside */
  int64_t body_face_count;
  const int32_t* wetted_faces; /* the part of it that fluid can wet */
  int64_t wetted_face_count;
} brs_compartment;

BRS_API brs_status brs_compartment_init(brs_compartment* compartment, int64_t struct_size);
/* After brs_scene_set_csf. index: of the compartment, from 0, or NULL. INVALID_ARGUMENT,
 * SURFACE_NOT_CLOSED, INDEX_OUT_OF_RANGE, SIZE; face numbers are checked by brs_stepper_create. */
BRS_API brs_status brs_scene_add_compartment(brs_scene* scene, const brs_compartment* compartment,
                                             int32_t* index);

/* ---- constraints: groups with a name and an id ---------------------------------------------------
 * nodes: count numbers. id: written if not NULL; stays valid in the steppers made from the scene.
 * Node numbers are checked by brs_stepper_create. All: INVALID_ARGUMENT, EMPTY, SIZE. */

enum { BRS_AXIS_X = 1, BRS_AXIS_Y = 2, BRS_AXIS_Z = 4, BRS_AXES = 7 };

/* The displacement of the nodes is zero along `axes`, a sum of the above. */
BRS_API brs_status brs_scene_add_fixed(brs_scene* scene, const char* name, const int32_t* nodes,
                                       int64_t count, int32_t axes, int32_t* id);
/* nodes[i] and partners[i] have the same displacement. */
BRS_API brs_status brs_scene_add_tied(brs_scene* scene, const char* name, const int32_t* nodes,
                                      const int32_t* partners, int64_t count, int32_t* id);
/* Springs to the rest position. stiffness: mN/mm, one per node, or one for all
 * (stiffness_count 1). SIZE_MISMATCH. */
BRS_API brs_status brs_scene_add_support(brs_scene* scene, const char* name, const int32_t* nodes,
                                         int64_t count, const double* stiffness,
                                         int64_t stiffness_count, int32_t* id);
/* Nodes stay on the positive (side 1) or negative (side -1) side of the surface, without friction.
 * offsets: mm kept from it, one per node, or one for all (offset_count 1), or none (0). A node's own
 * distance at rest, brs_surface_distance(), makes it touch from the beginning. SIZE_MISMATCH. */
BRS_API brs_status brs_scene_add_obstacle(brs_scene* scene, const char* name, const int32_t* nodes,
                                          int64_t count, brs_surface* surface, int32_t side,
                                          const double* offsets, int64_t offset_count, int32_t* id);
/* nodes[i] and partners[i] may part and slide, not pass through each other. normals: count x 3,
 * unit length, from partner to node. */
BRS_API brs_status brs_scene_add_opposing(brs_scene* scene, const char* name, const int32_t* nodes,
                                          const int32_t* partners, const double* normals,
                                          int64_t count, int32_t* id);

/* ---- stepper: the state, and the solves that change it ------------------------------------------- */

typedef struct brs_stepper brs_stepper;

typedef struct brs_stepper_options {
  int64_t struct_size;
  double residual_tolerance;        /* 1e-8, relative to the largest of the force norms */
  double complementarity_tolerance; /* 1e-8, relative */
  double correction_tolerance;      /* 1e-10, last correction relative to the mesh diameter */
  int64_t max_iterations;           /* 60, Newton iterations per load step */
  double smallest_load_step;        /* 1/256; below it: no equilibrium */
  double initial_penetration;       /* 1e-6, accepted at the start, relative to the diameter */
} brs_stepper_options;

BRS_API brs_status brs_stepper_options_init(brs_stepper_options* options, int64_t struct_size);

/* Copies the scene, which may be changed or destroyed afterwards. options: NULL for the defaults.
 * Errors name what is wrong with the scene: INVALID_ARGUMENT, EMPTY, INDEX_OUT_OF_RANGE,
 * SURFACE_NOT_CLOSED, INITIAL_PENETRATION, CONFLICTING_CONSTRAINTS, FLUID_VOLUME. */
BRS_API brs_status brs_stepper_create(brs_scene* scene, const brs_stepper_options* options,
                                      brs_stepper** stepper);
BRS_API brs_status brs_stepper_destroy(brs_stepper* stepper);

/* Settings, taken up by the next solve. */

/* gravity: 3 numbers, mm/s^2. NOT_FINITE. */
BRS_API brs_status brs_stepper_set_gravity(brs_stepper* stepper, const double* gravity);
/* on: non-zero enables the constraints of this id, 0 disables them. INVALID_ARGUMENT. */
BRS_API brs_status brs_stepper_set_enabled(brs_stepper* stepper, int32_t id, int32_t on);

enum {
  BRS_CSF_FULL = 0,        /* closed, its fluid restored; no amount */
  BRS_CSF_OPEN = 1,        /* air may enter, nothing is lost yet; no amount */
  BRS_CSF_LEVEL = 2,       /* open; amount: the level, mm along -gravity from the origin */
  BRS_CSF_LOST_VOLUME = 3, /* open; amount: fluid lost since the reference, mm^3 */
  BRS_CSF_AIR_VOLUME = 4   /* open; amount: air inside, mm^3 >= 0 */
};

/* With BRS_CSF_COMMUNICATING the law of any open compartment is that of the one fluid, and volumes
 * count for all. INVALID_ARGUMENT, INDEX_OUT_OF_RANGE, NOT_FINITE, FLUID_VOLUME. */
BRS_API brs_status brs_stepper_set_csf(brs_stepper* stepper, int32_t compartment, int32_t law,
                                       double amount);

/* Certificate of a solve, measured on the state that it leaves behind. */
typedef struct brs_solve_report {
  int64_t struct_size;
  int64_t status;           /* as returned by the solve: BRS_OK or a remark */
  double residual;          /* largest unbalanced force / largest of the force norms */
  double complementarity;   /* max |min(gap, multiplier)|, scaled, over one-sided rows */
  double violation;         /* mm; largest negative gap */
  double last_correction;   /* mm; largest entry of the last Newton step */
  double smallest_jacobian; /* min det F over tets; > 0: nothing is inverted */
  double energy;            /* uJ, stored in tissue and supports */
  double load_factor;       /* part of the change of load that is in balance */
  int64_t load_steps;
  int64_t iterations; /* Newton */
  int64_t factorisations;
  int64_t shifted_factorisations; /* those that needed a projected or shifted tangent */
  int64_t active_contacts;
  double seconds, seconds_assembly, seconds_factor, seconds_line_search;
} brs_solve_report;

BRS_API brs_status brs_solve_report_init(brs_solve_report* report, int64_t struct_size);

/* Quasi-static equilibrium under the present settings. report: filled where the status is not
 * negative, or NULL. Remarks: NOT_CONVERGED, NO_EQUILIBRIUM, CANCELLED. RIGID_MODE, FLUID_VOLUME,
 * LINEAR_SOLVER, CALLBACK, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_solve_static(brs_stepper* stepper, brs_solve_report* report);

/* Fields of the state, row-major. N nodes, M tets. */
enum {
  BRS_FIELD_DISPLACEMENT = 0,   /* N x 3, mm */
  BRS_FIELD_POSITION = 1,       /* N x 3, mm */
  BRS_FIELD_JACOBIAN = 2,       /* M x 1, det F */
  BRS_FIELD_FLUID_PRESSURE = 3, /* N x 1, kPa; 0 where dry */
  BRS_FIELD_INTERNAL_FORCE = 4, /* N x 3, mN, of the material */
  BRS_FIELD_GRAVITY_FORCE = 5,  /* N x 3, mN, in full */
  BRS_FIELD_FLUID_FORCE = 6,    /* N x 3, mN, in full */
  BRS_FIELD_EXTERNAL_FORCE = 7  /* N x 3, mN, the two without those of a balanced reference */
};

/* A view of a field; that of the displacement is the state itself, without a copy. Valid until the
 * next solve, restore, view of the same field, or the end of the stepper. rows and columns may be
 * NULL. INVALID_ARGUMENT for an unknown field. */
BRS_API brs_status brs_stepper_field(brs_stepper* stepper, int32_t field, const double** values,
                                     int64_t* rows, int64_t* columns);

/* Displacement (mm, count x 3) of the material that lies at the points (mm, count x 3) in the mesh
 * as given; and where the material now at the points lay in it. tets: count numbers of the tets
 * that hold the points, -1 outside, or NULL. values may be points. SIZE. Remark: OUTSIDE. */
BRS_API brs_status brs_stepper_displacement_at(brs_stepper* stepper, const double* points,
                                               int64_t count, double* values, int32_t* tets);
BRS_API brs_status brs_stepper_rest_points_of(brs_stepper* stepper, const double* points,
                                              int64_t count, double* values, int32_t* tets);

typedef struct brs_compartment_state {
  int64_t struct_size;
  double head;          /* mm along -gravity from the origin; pressure is zero there */
  double fluid_volume;  /* mm^3 */
  double air_volume;    /* mm^3; 0 if closed */
  double tissue_volume; /* mm^3 */
  double lost_volume;   /* mm^3 of fluid since the reference state */
  int64_t open;         /* 1: air may enter */
} brs_compartment_state;

BRS_API brs_status brs_compartment_state_init(brs_compartment_state* state, int64_t struct_size);
/* INDEX_OUT_OF_RANGE, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_compartment(brs_stepper* stepper, int32_t compartment,
                                           brs_compartment_state* state);

/* One-sided constraints: gap >= 0, multiplier >= 0, gap * multiplier = 0. */
typedef struct brs_contact_state {
  int64_t struct_size;
  int64_t count;            /* rows, in the order of the nodes of the group */
  int64_t active;           /* rows with a positive multiplier */
  const double* gap;        /* count, mm; NaN for rows that are not in the scene */
  const double* multiplier; /* count, mN */
  const double* force;      /* count x 3, mN, on the nodes (partners feel the opposite) */
} brs_contact_state;

BRS_API brs_status brs_contact_state_init(brs_contact_state* state, int64_t struct_size);
/* Its arrays are valid until the same id is asked for again. INVALID_ARGUMENT, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_contact(brs_stepper* stepper, int32_t id, brs_contact_state* state);

/* ---- snapshot: a copy of state and settings; restoring it brings back the same bits --------------- */

typedef struct brs_snapshot brs_snapshot;

BRS_API brs_status brs_stepper_snapshot(brs_stepper* stepper, brs_snapshot** snapshot);
/* INVALID_ARGUMENT for a snapshot of another mesh. */
BRS_API brs_status brs_stepper_restore(brs_stepper* stepper, brs_snapshot* snapshot);
BRS_API brs_status brs_snapshot_destroy(brs_snapshot* snapshot);

#ifdef __cplusplus
}
#endif

#endif /* BRAINSHIFT_C_BRAINSHIFT_H */
