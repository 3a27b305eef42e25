/* libbrainshift in C: how the brain, and an electrode in it, move when cerebrospinal fluid (CSF) is
 * lost. docs/c-api.md says the same at more length.
 *
 * Units: mm, kg, s; hence force mN, stress kPa, energy uJ, density kg/mm^3; 1 mL = 1000 mm^3.
 * Arrays: row-major float64 and int32, as numpy and VTK hold them. Arrays passed in are read during
 * the call only and need no alignment. Counts are rows, 0 <= count < 2^31; NULL goes with count 0.
 * Each array is documented as "name: rows x columns", or "name: rows".
 *
 * Status: negative: refused or failed, nothing has changed. 0: done. Positive: done, with a remark.
 * brs_context_message() says the same in a sentence. Every function may return BRS_ERROR_NULL,
 * _HANDLE, _BUSY or _MEMORY; the others are listed with it.
 *
 * Handles: the caller owns what *_create returns (set to NULL on failure) and destroys it in any
 * order; destroying NULL is fine. Meshes, surfaces, devices and snapshots never change and may be
 * given to calls in other contexts and threads. A handle of the wrong type is refused; using a
 * destroyed handle is undefined. A call reports to the context of its first handle; where that is NULL, no message is
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
  BRS_INFEASIBLE = 5,     /* rows of a complementarity problem contradict each other */
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

/* ---- context: messages, log, progress, cancel, threads ----------------------------------------- */

typedef struct brs_context brs_context;

/* header_version: BRS_VERSION. BRS_ERROR_VERSION if that header does not go with this library:
 * another major version, another minor one before 1.0, or a header newer than the library. */
BRS_API brs_status brs_context_create(int32_t header_version, brs_context** context);
/* Other handles of the context stay usable. */
BRS_API brs_status brs_context_destroy(brs_context* context);

/* What the last call had to say, one sentence; "" after BRS_OK. Valid until the next call in the
 * context; callable from the thread that made the call, and from a callback. Never NULL. */
BRS_API const char* brs_context_message(const brs_context* context);

/* status: of the call that ends; text: its message, or one line about a solve that went well. */
typedef void (*brs_log_fn)(brs_status status, const char* text, void* user);

/* Called at the end of every call in the context that has something to say; NULL: no log. Calls into
 * the context from there are refused with BRS_ERROR_BUSY; an exception out of it is dropped. */
BRS_API brs_status brs_context_set_log(brs_context* context, brs_log_fn log, void* user);
/* Threads of each solve, 1 or more, the calling one among them, in steppers made from now on whose
 * options do not say. Results are the same bits for any number. INVALID_ARGUMENT. */
BRS_API brs_status brs_context_set_threads(brs_context* context, int32_t threads);

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

/* nodes: node_count x 3, mm. tets: tet_count x 4, nodes, (p1-p0) x (p2-p0) . (p3-p0) > 0; orient:
 * non-zero turns those of negative volume instead of refusing them. regions: tet_count, labels, or
 * NULL for all 0. Errors name the first culprit: EMPTY, NOT_FINITE, INDEX_OUT_OF_RANGE,
 * INVERTED_ELEMENT, DEGENERATE_ELEMENT, DUPLICATE_ELEMENT, ORPHAN_NODE, SIZE. */
BRS_API brs_status brs_mesh_create(brs_context* context, const double* nodes, int64_t node_count,
                                   const int32_t* tets, int64_t tet_count, const int32_t* regions,
                                   int32_t orient, brs_mesh** mesh);

/* Order of the six edges of a quadratic tet. */
enum {
  BRS_EDGES_VTK = 0, /* 01, 12, 02, 03, 13, 23 */
  BRS_EDGES_GMSH = 1 /* 01, 12, 02, 03, 23, 13 */
};

/* Quadratic tets with a node on each edge, which may be curved. nodes: node_count x 3, mm. tets:
 * tet_count x 4, corners. edge_nodes: tet_count x 6, in the order `edges`, above. regions: tet_count,
 * or NULL for all 0. orient and errors as of brs_mesh_create, and INVALID_ARGUMENT where an edge has
 * two nodes or a node two places, INVERTED_ELEMENT where a curved tet folds over itself. */
BRS_API brs_status brs_mesh_create_quadratic(brs_context* context, const double* nodes,
                                             int64_t node_count, const int32_t* tets,
                                             const int32_t* edge_nodes, int64_t tet_count,
                                             int32_t edges, const int32_t* regions, int32_t orient,
                                             brs_mesh** mesh);
/* The same mesh with quadratic tets: a node in the middle of each edge, after the others; faces of
 * the surface keep their numbers. quadratic: a handle of its own, also where the mesh is so already. */
BRS_API brs_status brs_mesh_quadratic(brs_mesh* mesh, brs_mesh** quadratic);
BRS_API brs_status brs_mesh_destroy(brs_mesh* mesh);

typedef struct brs_mesh_info {
  int64_t struct_size;
  int64_t node_count, tet_count, component_count;
  int64_t reoriented;        /* tets that were turned */
  double volume;             /* mm^3 */
  double diameter;           /* mm; diagonal of the bounding box */
  const double* nodes;       /* node_count x 3, mm */
  const int32_t* tets;       /* tet_count x 4 */
  const int32_t* regions;    /* tet_count */
  const int32_t* components; /* node_count; connected component of each node, from 0 */
  int64_t surface_count;
  const int32_t* surface_tets; /* surface_count; the tet of each face of brs_mesh_surface() */
  /* Of linear tets both counts are 0. */
  int64_t quadratic_tet_count, quadratic_face_count;
  const int32_t* edge_nodes; /* quadratic_tet_count x 6, in the order of VTK */
  const int32_t*
      surface_edge_nodes; /* quadratic_face_count x 3, on edges 01, 12, 20 of each face */
} brs_mesh_info;

BRS_API brs_status brs_mesh_info_init(brs_mesh_info* info, int64_t struct_size);
/* Its arrays are valid as long as the mesh. STRUCT_SIZE. */
BRS_API brs_status brs_mesh_describe(brs_mesh* mesh, brs_mesh_info* info);
/* Smallest dihedral angle of each tet, degrees. degrees: capacity. count: number of tets; the first
 * `capacity` are written. SIZE. */
BRS_API brs_status brs_mesh_dihedrals(brs_mesh* mesh, double* degrees, int64_t capacity,
                                      int64_t* count);
/* Where points lie: the tet that holds each, -1 outside, and its weights (barycentric; 0 outside).
 * points: count x 3, mm. tets: count. weights: count x 4, or NULL. SIZE, NOT_FINITE. Remark:
 * OUTSIDE. */
BRS_API brs_status brs_mesh_locate(brs_mesh* mesh, const double* points, int64_t count,
                                   int32_t* tets, double* weights);
/* Boundary faces, outward; valid as long as the mesh. triangles: count x 3, nodes. */
BRS_API brs_status brs_mesh_surface(brs_mesh* mesh, const int32_t** triangles, int64_t* count);
/* Rows of the surface that belong to tets of `region`, ascending, without those whose nodes are all
 * dry (a cut, a seam, a base). dry_nodes: dry_count, or none. faces: capacity. count: how many; the
 * first `capacity` of them are written. INDEX_OUT_OF_RANGE, SIZE. */
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
/* Signed distances at points. points: count x 3, mm. distances: count, mm. SIZE, NOT_FINITE. */
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
/* gravity: 3, mm/s^2. NOT_FINITE. */
BRS_API brs_status brs_scene_set_gravity(brs_scene* scene, const double* gravity);
/* Non-zero: the mesh is an image taken under gravity and full CSF, in balance with them, and loads
 * are differences from that. 0: the mesh is free of load; gravity and CSF act in full. */
BRS_API brs_status brs_scene_set_balanced_reference(brs_scene* scene, int32_t balanced);

/* Elements: linear tets as the mesh has them, linear tets that do not lock, or quadratic ones. */
enum {
  BRS_VOLUME_STRAIN_ELEMENT = 0, /* in each tet; locks as Poisson's ratio nears 1/2 */
  BRS_VOLUME_STRAIN_NODAL = 1    /* averaged around each node of linear tets; does not lock */
};

/* Where linear tets take the change of volume. INVALID_ARGUMENT; quadratic tets refuse NODAL in
 * brs_stepper_create. */
BRS_API brs_status brs_scene_set_volume_strain(brs_scene* scene, int32_t volume_strain);
/* The same scene, with the same ids, on quadratic tets: brs_mesh_quadratic(), constraints of the
 * nodes on edges between nodes of a group, BRS_VOLUME_STRAIN_ELEMENT. quadratic: a handle of its own.
 * INDEX_OUT_OF_RANGE for constraints on nodes that are not there. */
BRS_API brs_status brs_scene_quadratic(brs_scene* scene, brs_scene** quadratic);

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
  /* Closed rigid wall around tissue, fluid and air, triangles outward. */
  const double* wall_points; /* wall_point_count x 3, mm */
  int64_t wall_point_count;
  const int32_t* wall_triangles; /* wall_triangle_count x 3 */
  int64_t wall_triangle_count;
  /* Rows of the mesh surface: the closed surface of the tissue inside, and what fluid wets of it. */
  const int32_t* body_faces; /* body_face_count */
  int64_t body_face_count;
  const int32_t* wetted_faces; /* wetted_face_count */
  int64_t wetted_face_count;
} brs_compartment;

BRS_API brs_status brs_compartment_init(brs_compartment* compartment, int64_t struct_size);
/* After brs_scene_set_csf. index: of the compartment, from 0, or NULL. INVALID_ARGUMENT,
 * SURFACE_NOT_CLOSED, INDEX_OUT_OF_RANGE, SIZE; face numbers are checked by brs_stepper_create. */
BRS_API brs_status brs_scene_add_compartment(brs_scene* scene, const brs_compartment* compartment,
                                             int32_t* index);

/* ---- constraints: groups with a name and an id ---------------------------------------------------
 * id: of the group, or NULL; stays valid in the steppers made from the scene. Node numbers are
 * checked by brs_stepper_create. All: INVALID_ARGUMENT, EMPTY, SIZE. */

enum { BRS_AXIS_X = 1, BRS_AXIS_Y = 2, BRS_AXIS_Z = 4, BRS_AXES = 7 };

/* The displacement of the nodes is zero along `axes`, a sum of the above. nodes: count. */
BRS_API brs_status brs_scene_add_fixed(brs_scene* scene, const char* name, const int32_t* nodes,
                                       int64_t count, int32_t axes, int32_t* id);
/* nodes[i] and partners[i] have the same displacement. nodes: count. partners: count. */
BRS_API brs_status brs_scene_add_tied(brs_scene* scene, const char* name, const int32_t* nodes,
                                      const int32_t* partners, int64_t count, int32_t* id);
/* Springs to the rest position. nodes: count. stiffness: stiffness_count, mN/mm, one per node, or one
 * for all. SIZE_MISMATCH. */
BRS_API brs_status brs_scene_add_support(brs_scene* scene, const char* name, const int32_t* nodes,
                                         int64_t count, const double* stiffness,
                                         int64_t stiffness_count, int32_t* id);
/* Nodes stay on the positive (side 1) or negative (side -1) side of the surface, without friction.
 * nodes: count. offsets: offset_count, mm kept from it, one per node, or one for all, or none. A node's
 * own distance at rest, brs_surface_distance(), makes it touch from the beginning. SIZE_MISMATCH. */
BRS_API brs_status brs_scene_add_obstacle(brs_scene* scene, const char* name, const int32_t* nodes,
                                          int64_t count, brs_surface* surface, int32_t side,
                                          const double* offsets, int64_t offset_count, int32_t* id);
/* nodes[i] and partners[i] may part and slide, not pass through each other. nodes: count.
 * partners: count. normals: count x 3, of unit length, from partner to node. */
BRS_API brs_status brs_scene_add_opposing(brs_scene* scene, const char* name, const int32_t* nodes,
                                          const int32_t* partners, const double* normals,
                                          int64_t count, int32_t* id);

/* on: non-zero enables the group in steppers made from now on, 0 disables it. */
BRS_API brs_status brs_scene_set_enabled(brs_scene* scene, int32_t id, int32_t on);
BRS_API brs_status brs_scene_remove_constraint(brs_scene* scene, int32_t id);

/* ---- devices: cannula, electrode lead, wire ------------------------------------------------------
 * A line of nodes, node 0 at the tip, running to the wire. Each node has a frame (d1, d2, d3): d1
 * along the line away from the tip, d2 and d3 across. Arc lengths count from the tip. */

typedef struct brs_device brs_device;

/* Columns of a cross-section. */
enum {
  BRS_SECTION_AXIAL = 0,        /* EA, mN */
  BRS_SECTION_BENDING_2 = 1,    /* EI for bending in the plane (d1, d2), mN mm^2 */
  BRS_SECTION_BENDING_3 = 2,    /* EI for bending in the plane (d1, d3), mN mm^2 */
  BRS_SECTION_TORSION = 3,      /* GJ, mN mm^2 */
  BRS_SECTION_RADIUS = 4,       /* outer radius, mm */
  BRS_SECTION_SHEAR = 5,        /* shear factor * GA, mN; infinite: no shear */
  BRS_SECTION_LINE_DENSITY = 6, /* kg/mm, >= 0 */
  BRS_SECTION_COLUMNS = 7
};

/* Round tube (inner diameter 0: a rod) of one material. Diameters in mm, young in kPa, density in
 * kg/mm^3. section: 7. INVALID_ARGUMENT. */
BRS_API brs_status brs_section_tube(brs_context* context, double outer_diameter,
                                    double inner_diameter, double young, double poisson,
                                    double density, double* section);
/* Round device known by its bending stiffness (mN mm^2). section: 7. INVALID_ARGUMENT. */
BRS_API brs_status brs_section_rod(brs_context* context, double diameter, double bending,
                                   double poisson, double density, double* section);

/* nodes: node_count x 3, mm, the rest shape. sections: section_count x 7, one for all or one per
 * element. contacts: contact_count x 2, mm, arc lengths of begin and end, or none. frames:
 * frame_count x 9, the vectors d1, d2, d3 of each node, or none: d1 tangent to the polyline. EMPTY,
 * SIZE_MISMATCH, NOT_FINITE, DEGENERATE_ELEMENT, INVALID_ARGUMENT, SIZE. */
BRS_API brs_status brs_device_create(brs_context* context, const char* name, const double* nodes,
                                     int64_t node_count, const double* sections,
                                     int64_t section_count, const double* contacts,
                                     int64_t contact_count, const double* frames,
                                     int64_t frame_count, brs_device** device);

typedef struct brs_device_options {
  int64_t struct_size;
  double element_size; /* mm, 2; elements are no longer than this */
  double bending;      /* EI, mN mm^2; 0: the table's */
  double density;      /* kg/mm^3 of the full cross-section; 0: massless */
} brs_device_options;

BRS_API brs_status brs_device_options_init(brs_device_options* options, int64_t struct_size);
/* A straight device of the table, `length` mm long from the tip to the end of the wire. options: NULL
 * for the defaults. INVALID_ARGUMENT names the known ones. */
BRS_API brs_status brs_device_create_named(brs_context* context, const char* name, double length,
                                           const brs_device_options* options, brs_device** device);
BRS_API brs_status brs_device_destroy(brs_device* device);

typedef struct brs_device_entry {
  int64_t struct_size;
  const char* name;
  const char* description; /* with the sources of the numbers */
  double outer_diameter;   /* mm */
  double tip;              /* mm from the tip to the first contact */
  int64_t contact_count;
  double contact_length, contact_gap;              /* mm */
  double bending, bending_lowest, bending_highest; /* EI, mN mm^2: default and range */
} brs_device_entry;

BRS_API brs_status brs_device_entry_init(brs_device_entry* entry, int64_t struct_size);
/* Entry `index` of the table of devices; its texts are valid for ever. INDEX_OUT_OF_RANGE beyond the
 * last one, STRUCT_SIZE. */
BRS_API brs_status brs_device_table(brs_context* context, int32_t index, brs_device_entry* entry);

typedef struct brs_device_info {
  int64_t struct_size;
  const char* name;
  double length; /* mm */
  int64_t node_count, contact_count;
  const double* nodes;    /* node_count x 3, mm, at rest */
  const double* arcs;     /* node_count, mm */
  const double* frames;   /* node_count x 9: d1, d2, d3 */
  const double* contacts; /* contact_count x 2, mm: arc lengths of begin and end */
} brs_device_info;

BRS_API brs_status brs_device_info_init(brs_device_info* info, int64_t struct_size);
/* Its arrays are valid as long as the device. STRUCT_SIZE. */
BRS_API brs_status brs_device_describe(brs_device* device, brs_device_info* info);

/* ---- stepper: the state, and the solves that change it ------------------------------------------- */

typedef struct brs_stepper brs_stepper;

typedef struct brs_stepper_options {
  int64_t struct_size;
  double residual_tolerance;        /* 1e-8, relative to the largest of the force norms */
  double complementarity_tolerance; /* 1e-8, relative */
  double correction_tolerance;      /* 4e-11, last correction relative to the mesh diameter */
  int64_t max_iterations;           /* 60, Newton iterations per load step */
  double smallest_load_step;        /* 1/256; below it: no equilibrium */
  double initial_penetration;       /* 1e-6, accepted at the start, relative to the diameter */
  int64_t threads;                  /* 0: as brs_context_set_threads() says, 1 without */
  double time_limit;                /* s from the begin of a solve, infinite; then BRS_CANCELLED */
} brs_stepper_options;

BRS_API brs_status brs_stepper_options_init(brs_stepper_options* options, int64_t struct_size);
/* Tolerances for which what a solve leaves open moves no node of the mesh by more than about `accuracy`
 * (mm, > 0). options: after its _init; the three tolerances are written. INVALID_ARGUMENT, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_options_within(brs_mesh* mesh, double accuracy, brs_stepper_options* options);

/* Copies the scene, which may be changed or destroyed afterwards. options: NULL for the defaults.
 * Errors name what is wrong with the scene: INVALID_ARGUMENT, EMPTY, INDEX_OUT_OF_RANGE,
 * SURFACE_NOT_CLOSED, INITIAL_PENETRATION, CONFLICTING_CONSTRAINTS, FLUID_VOLUME. */
BRS_API brs_status brs_stepper_create(brs_scene* scene, const brs_stepper_options* options,
                                      brs_stepper** stepper);
BRS_API brs_status brs_stepper_destroy(brs_stepper* stepper);
/* Its mesh (of a quadratic scene, of a replay). mesh: a handle of its own. */
BRS_API brs_status brs_stepper_mesh(brs_stepper* stepper, brs_mesh** mesh);

/* Settings, taken up by the next solve. */

/* gravity: 3, mm/s^2. NOT_FINITE. */
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

/* Rayleigh damping of brs_stepper_step(): alpha (1/s) times mass, beta (s) times stiffness.
 * NOT_FINITE, INVALID_ARGUMENT. */
BRS_API brs_status brs_stepper_set_damping(brs_stepper* stepper, double alpha, double beta);
/* Says what solve_static() would refuse under the present settings; changes nothing. */
BRS_API brs_status brs_stepper_check_settings(brs_stepper* stepper);

/* Devices in tissue. Each call takes effect at once (nothing moves) and is balanced by the next solve;
 * while a solve is begun, those that change something are refused with INVALID_ARGUMENT, as is an id
 * that is not there. */

/* What holds a device; arc lengths from its tip, mm. */
typedef struct brs_hold {
  int64_t struct_size;
  double rigid_from; /* from here to the wire end it stays where it was put; infinite: nowhere */
  double anchor;     /* here the wire is fixed to the skull; infinite: nowhere */
  double slack;      /* mm, 0; the wire may slide this far along its placement, either way */
  int64_t clamped;   /* 0; 1: the wire may not turn at its anchor */
} brs_hold;

BRS_API brs_status brs_hold_init(brs_hold* hold, int64_t struct_size);

typedef struct brs_track_options {
  int64_t struct_size;
  double shear_bound;   /* kPa, 0; friction along the device */
  double tip_bound;     /* mN, 0; friction at the deepest point besides */
  double least_spacing; /* mm, 1; path points closer than this are one */
  int64_t local_give;   /* 0; 1: tissue gives way beside a device thinner than its elements */
} brs_track_options;

BRS_API brs_status brs_track_options_init(brs_track_options* options, int64_t struct_size);

/* Inserts a straight, unloaded device: the tissue that lies on its line now is held across it from
 * then on and slides along it. tip: 3, mm. outward: 3, of unit length, from the tip to the wire.
 * hold: what holds it. options: NULL for the defaults. id: of the inserted device.
 * INVALID_ARGUMENT, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_insert(brs_stepper* stepper, brs_device* device, const double* tip,
                                      const double* outward, const brs_hold* hold,
                                      const brs_track_options* options, int32_t* id);
/* Another device on the same track, its tip `advance` (mm, >= 0) deeper. INVALID_ARGUMENT,
 * STRUCT_SIZE. */
BRS_API brs_status brs_stepper_exchange(brs_stepper* stepper, int32_t id, brs_device* device,
                                        const brs_hold* hold, double advance);
/* Another hold, in the shape the device has now. INVALID_ARGUMENT, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_set_hold(brs_stepper* stepper, int32_t id, const brs_hold* hold);
/* Other bounds of friction, kPa and mN; forces above them fall to them at once. INVALID_ARGUMENT. */
BRS_API brs_status brs_stepper_set_friction(brs_stepper* stepper, int32_t id, double shear_bound,
                                            double tip_bound);
/* INVALID_ARGUMENT. */
BRS_API brs_status brs_stepper_remove_device(brs_stepper* stepper, int32_t id);

/* Bytes that a solve holds at its peak besides mesh and state; known from patterns alone. */
typedef struct brs_memory_estimate {
  int64_t struct_size;
  int64_t factor;     /* of the tissue's matrix */
  int64_t border;     /* beside it: paths of devices, and contacts, as many as may stand there */
  int64_t compliance; /* of those and of coupling rows: dense */
  int64_t rest;       /* matrices, what belongs to nodes and tets, work space of all of it */
  int64_t total;
} brs_memory_estimate;

BRS_API brs_status brs_memory_estimate_init(brs_memory_estimate* estimate, int64_t struct_size);
/* What a solve under the present settings will take, before any of it is taken. Costs a symbolic
 * analysis, which the next solve need not repeat. LINEAR_SOLVER where the factor is beyond what the
 * solver can number; CONFLICTING_CONSTRAINTS, FLUID_VOLUME, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_memory_estimate(brs_stepper* stepper, brs_memory_estimate* estimate);

/* Tangent of the tissue on what fixed rows and contacts leave free, without devices and given volumes of
 * fluid, which may hold what it does not. */
enum {
  BRS_TANGENT_NOT_EXAMINED = 0,      /* nothing had to be solved, or a factor from far away has served to
                                        the end */
  BRS_TANGENT_POSITIVE_DEFINITE = 1, /* where it was factored last, next to the state */
  BRS_TANGENT_INDEFINITE = 2         /* at the state, which may not be stable; the log says so */
};

/* Certificate of a solve, measured on the state that it leaves behind. */
typedef struct brs_solve_report {
  int64_t struct_size;
  int64_t status;           /* as returned by the solve: BRS_OK or a remark */
  double residual;          /* largest unbalanced force / largest of the force norms */
  double complementarity;   /* max |min(gap, multiplier)|, scaled, over one-sided rows */
  double violation;         /* mm; largest negative gap */
  double last_correction;   /* mm; largest entry of the last Newton step */
  double smallest_jacobian; /* min det F over tets; > 0: nothing is inverted */
  double energy;            /* uJ, stored in tissue, supports and devices */
  double load_factor;       /* part of the change of load that is in balance */
  int64_t load_steps;
  int64_t iterations; /* Newton */
  int64_t factorisations;
  int64_t shifted_factorisations; /* those that needed a projected or shifted tangent */
  int64_t active_contacts;
  double seconds, seconds_assembly, seconds_factor, seconds_line_search;
  double kinetic_energy;   /* uJ of tissue and devices; 0 in statics */
  double tie_gap;          /* mm; largest gap across between a track and its device */
  int64_t coupling_rows;   /* of tissue and devices */
  int64_t coupling_rank;   /* of those whose force ended between its bounds */
  int64_t coupling_unique; /* 1; 0: they are dependent, and only sums of their forces are unique */
  int64_t tangent;         /* of a solve that converged, above */
  int64_t blas_threads;    /* the BLAS may use; 1: the same bits again; else only to rounding. 0: it
                              does not tell */
} brs_solve_report;

BRS_API brs_status brs_solve_report_init(brs_solve_report* report, int64_t struct_size);

/* Quasi-static equilibrium under the present settings. report: filled where the status is not
 * negative, or NULL. Remarks: NOT_CONVERGED, NO_EQUILIBRIUM, CANCELLED. RIGID_MODE, FLUID_VOLUME,
 * LINEAR_SOLVER, CALLBACK, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_solve_static(brs_stepper* stepper, brs_solve_report* report);

/* One step of backward Euler over dt (s); dt > 0. report and statuses as above, INVALID_ARGUMENT. */
BRS_API brs_status brs_stepper_step(brs_stepper* stepper, double dt, brs_solve_report* report);
/* Velocity of the tissue nodes. velocity: count x 3, mm/s; as many rows as nodes. SIZE_MISMATCH,
 * NOT_FINITE, SIZE. */
BRS_API brs_status brs_stepper_set_velocity(brs_stepper* stepper, const double* velocity,
                                            int64_t count);

/* The phases of a solve: begin; linearise, solve and update, in this order, while the phase is BEGUN
 * or UPDATED; accept when it is CONVERGED, reject when it is FAILED (or at any time). In between
 * everything shows the state of before, save BRS_FIELD_ITERATE and the progress report; calls that
 * change the state are refused. A call out of order is INVALID_ARGUMENT. */
enum {
  BRS_PHASE_IDLE = 0,       /* no solve is begun */
  BRS_PHASE_BEGUN = 1,      /* ready for linearise */
  BRS_PHASE_LINEARISED = 2, /* ready for solve */
  BRS_PHASE_SOLVED = 3,     /* ready for update */
  BRS_PHASE_UPDATED = 4,    /* ready for linearise again */
  BRS_PHASE_CONVERGED = 5,  /* ready for accept */
  BRS_PHASE_FAILED = 6      /* only reject is left */
};

/* Both refuse what the solve of the same name refuses; no solve is begun then. */
BRS_API brs_status brs_stepper_begin_static(brs_stepper* stepper);
BRS_API brs_status brs_stepper_begin_step(brs_stepper* stepper, double dt);
BRS_API brs_status brs_stepper_linearise(brs_stepper* stepper);
BRS_API brs_status brs_stepper_solve(brs_stepper* stepper);
/* phase: UPDATED, CONVERGED or FAILED, or NULL. Remarks where it is FAILED: NOT_CONVERGED,
 * NO_EQUILIBRIUM, CANCELLED. */
BRS_API brs_status brs_stepper_update(brs_stepper* stepper, int32_t* phase);
/* The iterate becomes the state. report: its certificate, or NULL. STRUCT_SIZE. */
BRS_API brs_status brs_stepper_accept(brs_stepper* stepper, brs_solve_report* report);
/* The state stays that of before the begin. */
BRS_API brs_status brs_stepper_reject(brs_stepper* stepper);
/* phase: the present one. */
BRS_API brs_status brs_stepper_phase(brs_stepper* stepper, int32_t* phase);
/* Report of the open solve, on its last iterate. STRUCT_SIZE. */
BRS_API brs_status brs_stepper_progress_report(brs_stepper* stepper, brs_solve_report* report);

/* Fields of the state, row-major. N nodes, M tets. */
enum {
  BRS_FIELD_DISPLACEMENT = 0,   /* N x 3, mm */
  BRS_FIELD_POSITION = 1,       /* N x 3, mm */
  BRS_FIELD_JACOBIAN = 2,       /* M x 1, det F */
  BRS_FIELD_FLUID_PRESSURE = 3, /* N x 1, kPa; 0 where dry */
  BRS_FIELD_INTERNAL_FORCE = 4, /* N x 3, mN, of the material */
  BRS_FIELD_GRAVITY_FORCE = 5,  /* N x 3, mN, in full */
  BRS_FIELD_FLUID_FORCE = 6,    /* N x 3, mN, in full */
  BRS_FIELD_EXTERNAL_FORCE = 7, /* N x 3, mN, the two without those of a balanced reference */
  BRS_FIELD_VELOCITY = 8,       /* N x 3, mm/s; 0 after a static solve */
  BRS_FIELD_ITERATE = 9,        /* N x 3, mm; displacement of the solve that is begun */
  BRS_FIELD_FARTHEST = 10       /* N x 3, mm; how far the last solve came, which has failed: in balance
                                   under load_factor of its report; not the state */
};

/* A view of a field; displacement, velocity, iterate and farthest are the stepper's own, without a copy. Valid
 * until the next solve, phase, restore, view of the same field, or the end of the stepper.
 * values: rows x columns. INVALID_ARGUMENT for an unknown field, and for one that is not there; rows and
 * columns may be NULL. */
BRS_API brs_status brs_stepper_field(brs_stepper* stepper, int32_t field, const double** values,
                                     int64_t* rows, int64_t* columns);

/* Displacement (mm) of the material that lies at the points in the mesh as given. points: count x 3,
 * mm. values: count x 3; may be the same array. tets: count, the tets that hold the points, -1
 * outside, or NULL. SIZE. Remark: OUTSIDE. */
BRS_API brs_status brs_stepper_displacement_at(brs_stepper* stepper, const double* points,
                                               int64_t count, double* values, int32_t* tets);
/* Where the material that is at the points now lay in the mesh as given (mm). points: count x 3, mm.
 * values: count x 3; may be the same array. tets: count, or NULL. SIZE. Remark: OUTSIDE. */
BRS_API brs_status brs_stepper_rest_points_of(brs_stepper* stepper, const double* points,
                                              int64_t count, double* values, int32_t* tets);

/* The error that the mesh leaves in the displacement of points, for linear tets and a state at rest:
 * what quadratic tets would change, to first order. points: count x 3, mm, in the mesh as given.
 * errors: count, mm; NaN outside. corrections: count x 3, mm, whose lengths these are, or NULL. Costs
 * a factorisation and some tens of products with the matrix of quadratic tets. INVALID_ARGUMENT on
 * quadratic tets or in motion, LINEAR_SOLVER, SIZE. Remark: OUTSIDE. */
BRS_API brs_status brs_stepper_estimate_error(brs_stepper* stepper, const double* points,
                                              int64_t count, double* errors, double* corrections);

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
  const int32_t* nodes;     /* count; of a quadratic scene with those on edges */
  int64_t partner_count;    /* count of an opposing group, or 0 */
  const int32_t* partners;  /* partner_count */
} brs_contact_state;

BRS_API brs_status brs_contact_state_init(brs_contact_state* state, int64_t struct_size);
/* Its arrays are valid until the same id is asked for again. INVALID_ARGUMENT, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_contact(brs_stepper* stepper, int32_t id, brs_contact_state* state);

/* An inserted device. Forces act on the tissue. */
typedef struct brs_device_state {
  int64_t struct_size;
  const char* name;
  int64_t node_count, contact_count, path_count;
  const double* nodes;           /* node_count x 3, mm; row 0 is the tip */
  const double* frames;          /* node_count x 9: d1, d2, d3 */
  const double* contact_centres; /* contact_count x 3, mm */
  const double* path;            /* path_count x 3, mm: where the material of the track is now */
  const double* path_arcs;       /* path_count, mm on the device; NaN where it does not reach */
  const double* path_forces;     /* path_count x 3, mN */
  double anchor_force[3];        /* mN, of skull and frame on the device */
  double slide;                  /* mm; how far slack has let the wire out (+) or in (-) */
  double bow, bow_arc;           /* mm; largest distance from its chord, and where */
  double bow_direction[3];       /* unit; zero without bow */
  double largest_tie_gap;        /* mm */
} brs_device_state;

BRS_API brs_status brs_device_state_init(brs_device_state* state, int64_t struct_size);
/* Its arrays are valid until the same id is asked for again. INVALID_ARGUMENT, STRUCT_SIZE. */
BRS_API brs_status brs_stepper_device(brs_stepper* stepper, int32_t id, brs_device_state* state);
/* The device that was inserted under this id last, as a handle of its own. INVALID_ARGUMENT. */
BRS_API brs_status brs_stepper_device_model(brs_stepper* stepper, int32_t id, brs_device** device);

/* ---- snapshot: a copy of state and settings; restoring it brings back the same bits --------------- */

typedef struct brs_snapshot brs_snapshot;

BRS_API brs_status brs_stepper_snapshot(brs_stepper* stepper, brs_snapshot** snapshot);
/* INVALID_ARGUMENT for a snapshot of another mesh. */
BRS_API brs_status brs_stepper_restore(brs_stepper* stepper, brs_snapshot* snapshot);
BRS_API brs_status brs_snapshot_destroy(brs_snapshot* snapshot);

/* Snapshots and scenes as bytes, to be kept in files. They have a version and a checksum; bytes that
 * were damaged, or written by a library of another version of the format, are refused with FILE.
 * count: how many bytes there are; the first `capacity` are written. bytes: capacity. SIZE. */
BRS_API brs_status brs_snapshot_bytes(brs_snapshot* snapshot, uint8_t* bytes, int64_t capacity,
                                      int64_t* count);
/* The snapshot that was written, for a stepper of the same scene: INVALID_ARGUMENT for another mesh
 * or other constraints and compartments. bytes: count. FILE, SIZE. */
BRS_API brs_status brs_stepper_read_snapshot(brs_stepper* stepper, const uint8_t* bytes,
                                             int64_t count, brs_snapshot** snapshot);
/* The scene of a stepper, its options, state and settings: all that a bug report needs. bytes:
 * capacity. count: how many there are; the first `capacity` are written. SIZE. */
BRS_API brs_status brs_stepper_record(brs_stepper* stepper, uint8_t* bytes, int64_t capacity,
                                      int64_t* count);
/* A stepper that goes on from what brs_stepper_record() wrote, with the same bits in the same build.
 * bytes: count. FILE, SIZE. */
BRS_API brs_status brs_stepper_replay(brs_context* context, const uint8_t* bytes, int64_t count,
                                      brs_stepper** stepper);

/* ---- mixed complementarity problems, alone -------------------------------------------------------
 * Find lower <= z <= upper with w = M z + q and, row by row, w >= 0 where z = lower, w <= 0 where
 * z = upper, w = 0 in between. Bounds may be infinite. */

enum {
  BRS_MCP_AUTOMATIC = 0,   /* semismooth Newton, then pivoting where it does not converge */
  BRS_MCP_NEWTON = 1,      /* semismooth Newton on the min function, with line search */
  BRS_MCP_PIVOTING = 2,    /* Lemke's complementary pivoting */
  BRS_MCP_GAUSS_SEIDEL = 3 /* projected Gauss-Seidel: a baseline */
};

typedef struct brs_mcp_options {
  int64_t struct_size;
  int64_t method;         /* 0, above */
  double noise;           /* 0; q is known to this, in the unit of w */
  double tolerance;       /* 1e-10, of the residual of the report */
  int64_t max_iterations; /* 100, of Newton */
  int64_t max_pivots;     /* 0: 50 + 10 count */
  int64_t max_sweeps;     /* 10000, of Gauss-Seidel */
} brs_mcp_options;

BRS_API brs_status brs_mcp_options_init(brs_mcp_options* options, int64_t struct_size);

/* Certificate, computed from the z returned, whatever the method says. */
typedef struct brs_mcp_report {
  int64_t struct_size;
  int64_t status;         /* as returned: BRS_OK or a remark */
  double residual;        /* largest |z - clamp(z - w, lower, upper)|, scaled row by row; no unit */
  int64_t iterations;     /* Newton iterations, pivots or sweeps */
  int64_t rank;           /* of the rows that ended strictly between their bounds */
  int64_t unique;         /* 1; 0: z is, or may be, one of many */
  int64_t conflict_count; /* INFEASIBLE: how many rows are proved to contradict each other */
} brs_mcp_report;

BRS_API brs_status brs_mcp_report_init(brs_mcp_report* report, int64_t struct_size);

/* matrix: count x count, M. q: count. lower: count. upper: count. options: NULL for the defaults. z:
 * count; void where it is INFEASIBLE. w: count, or NULL. conflict: count, or NULL; the rows that
 * contradict each other, then -1. report: filled where the status is not negative, or NULL. Remarks:
 * NOT_CONVERGED (z and w are the last ones), INFEASIBLE. NOT_FINITE, INVALID_ARGUMENT, STRUCT_SIZE,
 * SIZE. */
BRS_API brs_status brs_mcp_solve(brs_context* context, const double* matrix, const double* q,
                                 const double* lower, const double* upper, int64_t count,
                                 const brs_mcp_options* options, double* z, double* w,
                                 int32_t* conflict, brs_mcp_report* report);

#ifdef __cplusplus
}
#endif

#endif /* BRAINSHIFT_C_BRAINSHIFT_H */
