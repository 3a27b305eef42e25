/* Every function of the header, empty: what abidiff compares with the recorded ABI. The
 * functions of the library are held to the same header by its compiler, to the same names by the test capi.exports.
 * Written by capi/bindings/generate from include/brainshift/c/brainshift.h; do not edit. */
#include "brainshift/c/brainshift.h"

BRS_API int32_t brs_version(void) { return 0; }
BRS_API const char* brs_version_string(void) { return 0; }
BRS_API const char* brs_build_info(void) { return 0; }
BRS_API const char* brs_status_name(brs_status status) { return 0; }
BRS_API brs_status brs_context_create(int32_t header_version, brs_context** context) { return 0; }
BRS_API brs_status brs_context_destroy(brs_context* context) { return 0; }
BRS_API const char* brs_context_message(const brs_context* context) { return 0; }
BRS_API brs_status brs_context_set_log(brs_context* context, brs_log_fn log, void* user) { return 0; }
BRS_API brs_status brs_context_set_threads(brs_context* context, int32_t threads) { return 0; }
BRS_API brs_status brs_context_set_progress(brs_context* context, brs_progress_fn progress,
                                            void* user) { return 0; }
BRS_API brs_status brs_context_set_cancel(brs_context* context, int32_t cancel) { return 0; }
BRS_API brs_status brs_mesh_create(brs_context* context, const double* nodes, int64_t node_count,
                                   const int32_t* tets, int64_t tet_count, const int32_t* regions,
                                   int32_t orient, brs_mesh** mesh) { return 0; }
BRS_API brs_status brs_mesh_create_quadratic(brs_context* context, const double* nodes,
                                             int64_t node_count, const int32_t* tets,
                                             const int32_t* edge_nodes, int64_t tet_count,
                                             int32_t edges, const int32_t* regions, int32_t orient,
                                             brs_mesh** mesh) { return 0; }
BRS_API brs_status brs_mesh_quadratic(brs_mesh* mesh, brs_mesh** quadratic) { return 0; }
BRS_API brs_status brs_mesh_destroy(brs_mesh* mesh) { return 0; }
BRS_API brs_status brs_mesh_info_init(brs_mesh_info* info, int64_t struct_size) { return 0; }
BRS_API brs_status brs_mesh_describe(brs_mesh* mesh, brs_mesh_info* info) { return 0; }
BRS_API brs_status brs_mesh_dihedrals(brs_mesh* mesh, double* degrees, int64_t capacity,
                                      int64_t* count) { return 0; }
BRS_API brs_status brs_mesh_locate(brs_mesh* mesh, const double* points, int64_t count,
                                   int32_t* tets, double* weights) { return 0; }
BRS_API brs_status brs_mesh_surface(brs_mesh* mesh, const int32_t** triangles, int64_t* count) { return 0; }
BRS_API brs_status brs_mesh_faces(brs_mesh* mesh, int32_t region, const int32_t* dry_nodes,
                                  int64_t dry_count, int32_t* faces, int64_t capacity,
                                  int64_t* count) { return 0; }
BRS_API brs_status brs_surface_options_init(brs_surface_options* options, int64_t struct_size) { return 0; }
BRS_API brs_status brs_surface_create(brs_context* context, int32_t kind, const double* points,
                                      int64_t point_count, const int32_t* triangles,
                                      int64_t triangle_count, const brs_surface_options* options,
                                      brs_surface** surface) { return 0; }
BRS_API brs_status brs_surface_destroy(brs_surface* surface) { return 0; }
BRS_API brs_status brs_surface_distance(brs_surface* surface, const double* points, int64_t count,
                                        double* distances) { return 0; }
BRS_API brs_status brs_scene_create(brs_context* context, brs_mesh* mesh, brs_scene** scene) { return 0; }
BRS_API brs_status brs_scene_destroy(brs_scene* scene) { return 0; }
BRS_API brs_status brs_material_init(brs_material* material, int64_t struct_size) { return 0; }
BRS_API brs_status brs_scene_set_material(brs_scene* scene, int32_t region,
                                          const brs_material* material) { return 0; }
BRS_API brs_status brs_scene_set_gravity(brs_scene* scene, const double* gravity) { return 0; }
BRS_API brs_status brs_scene_set_balanced_reference(brs_scene* scene, int32_t balanced) { return 0; }
BRS_API brs_status brs_scene_set_volume_strain(brs_scene* scene, int32_t volume_strain) { return 0; }
BRS_API brs_status brs_scene_quadratic(brs_scene* scene, brs_scene** quadratic) { return 0; }
BRS_API brs_status brs_scene_set_csf(brs_scene* scene, double density, int32_t model,
                                     double reference_head) { return 0; }
BRS_API brs_status brs_compartment_init(brs_compartment* compartment, int64_t struct_size) { return 0; }
BRS_API brs_status brs_scene_add_compartment(brs_scene* scene, const brs_compartment* compartment,
                                             int32_t* index) { return 0; }
BRS_API brs_status brs_scene_add_fixed(brs_scene* scene, const char* name, const int32_t* nodes,
                                       int64_t count, int32_t axes, int32_t* id) { return 0; }
BRS_API brs_status brs_scene_add_tied(brs_scene* scene, const char* name, const int32_t* nodes,
                                      const int32_t* partners, int64_t count, int32_t* id) { return 0; }
BRS_API brs_status brs_scene_add_support(brs_scene* scene, const char* name, const int32_t* nodes,
                                         int64_t count, const double* stiffness,
                                         int64_t stiffness_count, int32_t* id) { return 0; }
BRS_API brs_status brs_scene_add_obstacle(brs_scene* scene, const char* name, const int32_t* nodes,
                                          int64_t count, brs_surface* surface, int32_t side,
                                          const double* offsets, int64_t offset_count, int32_t* id) { return 0; }
BRS_API brs_status brs_scene_add_opposing(brs_scene* scene, const char* name, const int32_t* nodes,
                                          const int32_t* partners, const double* normals,
                                          int64_t count, int32_t* id) { return 0; }
BRS_API brs_status brs_scene_set_enabled(brs_scene* scene, int32_t id, int32_t on) { return 0; }
BRS_API brs_status brs_scene_remove_constraint(brs_scene* scene, int32_t id) { return 0; }
BRS_API brs_status brs_section_tube(brs_context* context, double outer_diameter,
                                    double inner_diameter, double young, double poisson,
                                    double density, double* section) { return 0; }
BRS_API brs_status brs_section_rod(brs_context* context, double diameter, double bending,
                                   double poisson, double density, double* section) { return 0; }
BRS_API brs_status brs_device_create(brs_context* context, const char* name, const double* nodes,
                                     int64_t node_count, const double* sections,
                                     int64_t section_count, const double* contacts,
                                     int64_t contact_count, const double* frames,
                                     int64_t frame_count, brs_device** device) { return 0; }
BRS_API brs_status brs_device_options_init(brs_device_options* options, int64_t struct_size) { return 0; }
BRS_API brs_status brs_device_create_named(brs_context* context, const char* name, double length,
                                           const brs_device_options* options, brs_device** device) { return 0; }
BRS_API brs_status brs_device_destroy(brs_device* device) { return 0; }
BRS_API brs_status brs_device_entry_init(brs_device_entry* entry, int64_t struct_size) { return 0; }
BRS_API brs_status brs_device_table(brs_context* context, int32_t index, brs_device_entry* entry) { return 0; }
BRS_API brs_status brs_device_info_init(brs_device_info* info, int64_t struct_size) { return 0; }
BRS_API brs_status brs_device_describe(brs_device* device, brs_device_info* info) { return 0; }
BRS_API brs_status brs_stepper_options_init(brs_stepper_options* options, int64_t struct_size) { return 0; }
BRS_API brs_status brs_stepper_options_within(brs_mesh* mesh, double accuracy, brs_stepper_options* options) { return 0; }
BRS_API brs_status brs_stepper_create(brs_scene* scene, const brs_stepper_options* options,
                                      brs_stepper** stepper) { return 0; }
BRS_API brs_status brs_stepper_destroy(brs_stepper* stepper) { return 0; }
BRS_API brs_status brs_stepper_mesh(brs_stepper* stepper, brs_mesh** mesh) { return 0; }
BRS_API brs_status brs_stepper_set_gravity(brs_stepper* stepper, const double* gravity) { return 0; }
BRS_API brs_status brs_stepper_set_enabled(brs_stepper* stepper, int32_t id, int32_t on) { return 0; }
BRS_API brs_status brs_stepper_set_csf(brs_stepper* stepper, int32_t compartment, int32_t law,
                                       double amount) { return 0; }
BRS_API brs_status brs_stepper_set_damping(brs_stepper* stepper, double alpha, double beta) { return 0; }
BRS_API brs_status brs_stepper_check_settings(brs_stepper* stepper) { return 0; }
BRS_API brs_status brs_hold_init(brs_hold* hold, int64_t struct_size) { return 0; }
BRS_API brs_status brs_track_options_init(brs_track_options* options, int64_t struct_size) { return 0; }
BRS_API brs_status brs_stepper_insert(brs_stepper* stepper, brs_device* device, const double* tip,
                                      const double* outward, const brs_hold* hold,
                                      const brs_track_options* options, int32_t* id) { return 0; }
BRS_API brs_status brs_stepper_exchange(brs_stepper* stepper, int32_t id, brs_device* device,
                                        const brs_hold* hold, double advance) { return 0; }
BRS_API brs_status brs_stepper_set_hold(brs_stepper* stepper, int32_t id, const brs_hold* hold) { return 0; }
BRS_API brs_status brs_stepper_set_friction(brs_stepper* stepper, int32_t id, double shear_bound,
                                            double tip_bound) { return 0; }
BRS_API brs_status brs_stepper_remove_device(brs_stepper* stepper, int32_t id) { return 0; }
BRS_API brs_status brs_memory_estimate_init(brs_memory_estimate* estimate, int64_t struct_size) { return 0; }
BRS_API brs_status brs_stepper_memory_estimate(brs_stepper* stepper, brs_memory_estimate* estimate) { return 0; }
BRS_API brs_status brs_solve_report_init(brs_solve_report* report, int64_t struct_size) { return 0; }
BRS_API brs_status brs_stepper_solve_static(brs_stepper* stepper, brs_solve_report* report) { return 0; }
BRS_API brs_status brs_stepper_step(brs_stepper* stepper, double dt, brs_solve_report* report) { return 0; }
BRS_API brs_status brs_stepper_set_velocity(brs_stepper* stepper, const double* velocity,
                                            int64_t count) { return 0; }
BRS_API brs_status brs_stepper_begin_static(brs_stepper* stepper) { return 0; }
BRS_API brs_status brs_stepper_begin_step(brs_stepper* stepper, double dt) { return 0; }
BRS_API brs_status brs_stepper_linearise(brs_stepper* stepper) { return 0; }
BRS_API brs_status brs_stepper_solve(brs_stepper* stepper) { return 0; }
BRS_API brs_status brs_stepper_update(brs_stepper* stepper, int32_t* phase) { return 0; }
BRS_API brs_status brs_stepper_accept(brs_stepper* stepper, brs_solve_report* report) { return 0; }
BRS_API brs_status brs_stepper_reject(brs_stepper* stepper) { return 0; }
BRS_API brs_status brs_stepper_phase(brs_stepper* stepper, int32_t* phase) { return 0; }
BRS_API brs_status brs_stepper_progress_report(brs_stepper* stepper, brs_solve_report* report) { return 0; }
BRS_API brs_status brs_stepper_field(brs_stepper* stepper, int32_t field, const double** values,
                                     int64_t* rows, int64_t* columns) { return 0; }
BRS_API brs_status brs_stepper_displacement_at(brs_stepper* stepper, const double* points,
                                               int64_t count, double* values, int32_t* tets) { return 0; }
BRS_API brs_status brs_stepper_rest_points_of(brs_stepper* stepper, const double* points,
                                              int64_t count, double* values, int32_t* tets) { return 0; }
BRS_API brs_status brs_stepper_estimate_error(brs_stepper* stepper, const double* points,
                                              int64_t count, double* errors, double* corrections) { return 0; }
BRS_API brs_status brs_compartment_state_init(brs_compartment_state* state, int64_t struct_size) { return 0; }
BRS_API brs_status brs_stepper_compartment(brs_stepper* stepper, int32_t compartment,
                                           brs_compartment_state* state) { return 0; }
BRS_API brs_status brs_contact_state_init(brs_contact_state* state, int64_t struct_size) { return 0; }
BRS_API brs_status brs_stepper_contact(brs_stepper* stepper, int32_t id, brs_contact_state* state) { return 0; }
BRS_API brs_status brs_device_state_init(brs_device_state* state, int64_t struct_size) { return 0; }
BRS_API brs_status brs_stepper_device(brs_stepper* stepper, int32_t id, brs_device_state* state) { return 0; }
BRS_API brs_status brs_stepper_device_model(brs_stepper* stepper, int32_t id, brs_device** device) { return 0; }
BRS_API brs_status brs_stepper_snapshot(brs_stepper* stepper, brs_snapshot** snapshot) { return 0; }
BRS_API brs_status brs_stepper_restore(brs_stepper* stepper, brs_snapshot* snapshot) { return 0; }
BRS_API brs_status brs_snapshot_destroy(brs_snapshot* snapshot) { return 0; }
BRS_API brs_status brs_snapshot_bytes(brs_snapshot* snapshot, uint8_t* bytes, int64_t capacity,
                                      int64_t* count) { return 0; }
BRS_API brs_status brs_stepper_read_snapshot(brs_stepper* stepper, const uint8_t* bytes,
                                             int64_t count, brs_snapshot** snapshot) { return 0; }
BRS_API brs_status brs_stepper_record(brs_stepper* stepper, uint8_t* bytes, int64_t capacity,
                                      int64_t* count) { return 0; }
BRS_API brs_status brs_stepper_replay(brs_context* context, const uint8_t* bytes, int64_t count,
                                      brs_stepper** stepper) { return 0; }
BRS_API brs_status brs_mcp_options_init(brs_mcp_options* options, int64_t struct_size) { return 0; }
BRS_API brs_status brs_mcp_report_init(brs_mcp_report* report, int64_t struct_size) { return 0; }
BRS_API brs_status brs_mcp_solve(brs_context* context, const double* matrix, const double* q,
                                 const double* lower, const double* upper, int64_t count,
                                 const brs_mcp_options* options, double* z, double* w,
                                 int32_t* conflict, brs_mcp_report* report) { return 0; }
