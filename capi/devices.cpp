// Devices: cross-sections, models, the table.
#include "arrays.hpp"
#include "structs.hpp"

using namespace brainshift;
using namespace brainshift::capi;

namespace {

using Sections = Eigen::Matrix<double, Eigen::Dynamic, BRS_SECTION_COLUMNS, Eigen::RowMajor>;
using Pairs = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Frames = Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor>;

BeamSection section_of(const Sections& all, Eigen::Index i) {
  BeamSection s;
  s.axial = all(i, BRS_SECTION_AXIAL);
  s.bending_2 = all(i, BRS_SECTION_BENDING_2);
  s.bending_3 = all(i, BRS_SECTION_BENDING_3);
  s.torsion = all(i, BRS_SECTION_TORSION);
  s.radius = all(i, BRS_SECTION_RADIUS);
  s.shear = all(i, BRS_SECTION_SHEAR);
  s.line_density = all(i, BRS_SECTION_LINE_DENSITY);
  return s;
}

void write_section(const BeamSection& s, double* section) {
  const double columns[BRS_SECTION_COLUMNS] = {s.axial,  s.bending_2, s.bending_3,   s.torsion,
                                               s.radius, s.shear,     s.line_density};
  std::memcpy(&result(section, "section"), columns, sizeof columns);
}

const double* view_of_contacts(const std::vector<Contact>& contacts) {
  static_assert(sizeof(Contact) == 2 * sizeof(double));
  return contacts.empty() ? nullptr : &contacts.front().from;
}

brs_device_options device_defaults() {
  const DeviceOptions d;
  return {sizeof(brs_device_options), d.element_size, d.bending, d.density};
}

}  // namespace

brs_status brs_section_tube(brs_context* context, double outer_diameter, double inner_diameter,
                            double young, double poisson, double density, double* section) {
  return guard(context, [&](brs_context&) {
    write_section(tube_section(outer_diameter, inner_diameter, young, poisson, density), section);
  });
}

brs_status brs_section_rod(brs_context* context, double diameter, double bending, double poisson,
                           double density, double* section) {
  return guard(context, [&](brs_context&) {
    write_section(rod_section(diameter, bending, poisson, density), section);
  });
}

brs_status brs_device_create(brs_context* context, const char* name, const double* nodes,
                             int64_t node_count, const double* sections, int64_t section_count,
                             const double* contacts, int64_t contact_count, const double* frames,
                             int64_t frame_count, brs_device** device) {
  return create(context, device, "device", [&](brs_context& c) {
    const auto columns = rows<Sections>(sections, section_count, "sections");
    const auto rings = rows<Pairs>(contacts, contact_count, "contacts");
    const auto axes = rows<Frames>(frames, frame_count, "frames");
    std::vector<BeamSection> each;
    for (Eigen::Index i = 0; i < columns.rows(); ++i) each.push_back(section_of(columns, i));
    std::vector<Contact> from_to;
    for (Eigen::Index i = 0; i < rings.rows(); ++i) from_to.push_back({rings(i, 0), rings(i, 1)});
    std::vector<Mat3> turned;
    for (Eigen::Index i = 0; i < axes.rows(); ++i)
      turned.push_back(Eigen::Map<const Mat3>(axes.row(i).data()));
    return new brs_device(c.context,
                          BeamDevice(text(name, "name"), rows<Points>(nodes, node_count, "nodes"),
                                     std::move(each), std::move(from_to), std::move(turned)));
  });
}

brs_status brs_device_options_init(brs_device_options* options, int64_t struct_size) {
  return init(options, struct_size, device_defaults());
}

brs_status brs_device_create_named(brs_context* context, const char* name, double length,
                                   const brs_device_options* options, brs_device** device) {
  return create(context, device, "device", [&](brs_context& c) {
    brs_device_options o = device_defaults();
    if (options) o = read(options, o, "options");
    return new brs_device(
        c.context, make_device(text(name, "name"), length, {o.element_size, o.bending, o.density}));
  });
}

brs_status brs_device_destroy(brs_device* device) { return destroy_immutable(device); }

brs_status brs_device_entry_init(brs_device_entry* entry, int64_t struct_size) {
  return init(entry, struct_size, brs_device_entry{});
}

brs_status brs_device_table(brs_context* context, int32_t index, brs_device_entry* entry) {
  return guard(context, [&](brs_context&) {
    checked_size(entry, "entry");
    const std::vector<std::string> names = device_names();
    if (index < 0 || std::size_t(index) >= names.size())
      throw Refusal(BRS_ERROR_INDEX_OUT_OF_RANGE, "the table of devices has no entry " +
                                                      std::to_string(index) + " of " +
                                                      std::to_string(names.size()));
    const DeviceData& d = device_data(names[std::size_t(index)]);
    write(entry,
          brs_device_entry{sizeof(brs_device_entry), d.name, d.description, d.outer_diameter, d.tip,
                           d.contact_count, d.contact_length, d.contact_gap, d.bending,
                           d.bending_lowest, d.bending_highest},
          "entry");
  });
}

brs_status brs_device_info_init(brs_device_info* info, int64_t struct_size) {
  return init(info, struct_size, brs_device_info{});
}

brs_status brs_device_describe(brs_device* device, brs_device_info* info) {
  return guard(device, [&](brs_device& d) {
    const BeamDevice& v = d.value;
    write(info,
          brs_device_info{sizeof(brs_device_info), v.name().c_str(), v.length(), v.node_count(),
                          int64_t(v.contacts().size()), v.nodes().data(), v.arcs().data(),
                          view_of_frames(v.frames()), view_of_contacts(v.contacts())},
          "info");
  });
}
