#include "brainshift/beam_device.hpp"

#include <algorithm>
#include <cmath>

#include "beam/element.hpp"
#include "beam/rotation.hpp"
#include "brainshift/error.hpp"
#include "text.hpp"

namespace brainshift {

struct BeamDevice::Data {
  std::string name;
  Points nodes;
  std::vector<BeamSection> sections;  // per element
  std::vector<Contact> contacts;
  std::vector<Mat3> frames;
  Eigen::VectorXd arcs;
};

namespace {

constexpr double pi = 3.14159265358979323846;

std::string of_device(const std::string& name) { return "device '" + name + "': "; }

void check_section(const std::string& where, const BeamSection& s) {
  const struct {
    const char* name;
    double value;
  } positive[] = {{"axial", s.axial},     {"bending_2", s.bending_2}, {"bending_3", s.bending_3},
                  {"torsion", s.torsion}, {"radius", s.radius},       {"shear", s.shear}};
  for (const auto& entry : positive) {
    const bool infinite_shear = &entry == &positive[5] && entry.value > 0.0;
    if (std::isnan(entry.value) || (std::isinf(entry.value) && !infinite_shear)) {
      throw Error(ErrorCode::not_finite, where + entry.name + " is not finite");
    }
    if (entry.value <= 0.0) {
      throw Error(ErrorCode::invalid_argument,
                  where + entry.name + " = " + text(entry.value) + " is not positive");
    }
  }
  if (!std::isfinite(s.line_density)) {
    throw Error(ErrorCode::not_finite, where + "line_density is not finite");
  }
  if (s.line_density < 0.0) {
    throw Error(ErrorCode::invalid_argument,
                where + "line_density = " + text(s.line_density) + " is negative");
  }
}

void check_nodes(const std::string& who, const Points& nodes) {
  if (nodes.rows() < 2) {
    throw Error(ErrorCode::empty,
                who + "needs at least 2 nodes, not " + std::to_string(nodes.rows()));
  }
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    if (!nodes.row(i).allFinite()) {
      throw Error(ErrorCode::not_finite, who + "node " + std::to_string(i) + " is not finite");
    }
  }
  // below this, chords are made of the rounding of the coordinates
  const double least = 1e-10 * nodes.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i + 1 < nodes.rows(); ++i) {
    if ((nodes.row(i + 1) - nodes.row(i)).norm() <= least) {
      throw Error(ErrorCode::degenerate_element,
                  who + "element " + std::to_string(i) + " has no length: its nodes " +
                      std::to_string(i) + " and " + std::to_string(i + 1) + " coincide");
    }
  }
}

void check_frames(const std::string& who, const Points& nodes, const std::vector<Mat3>& frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Mat3& R = frames[i];
    const bool rotation = (R.transpose() * R - Mat3::Identity()).cwiseAbs().maxCoeff() <= 1e-6 &&
                          R.determinant() > 0.0;
    if (!rotation) {
      throw Error(ErrorCode::invalid_argument,
                  who + "frame " + std::to_string(i) + " is not a rotation");
    }
  }
  for (Eigen::Index i = 0; i + 1 < nodes.rows(); ++i) {
    const Vec3 chord = nodes.row(i + 1) - nodes.row(i);
    for (const Eigen::Index end : {i, i + 1}) {
      if (chord.dot(frames[std::size_t(end)].col(0)) <= 0.0) {
        throw Error(ErrorCode::invalid_argument,
                    who + "the line turns by more than a right angle " + "between element " +
                        std::to_string(i) + " and the frame of node " + std::to_string(end));
      }
    }
  }
}

void check_contacts(const std::string& who, const std::vector<Contact>& contacts, double length) {
  double last = 0.0;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Contact& c = contacts[k];
    // written so that NaN fails too; the length of a curve is rounded
    if (!(c.from >= last && c.to > c.from && c.to <= length * (1.0 + 1e-9))) {
      throw Error(ErrorCode::invalid_argument,
                  who + "contact " + std::to_string(k) + " from " + text(c.from) + " to " +
                      text(c.to) + " mm overlaps the one before or leaves the device (" +
                      text(length) + " mm)");
    }
    last = c.to;
  }
}

}  // namespace

BeamSection tube_section(double outer, double inner, double young, double poisson, double density) {
  if (!(outer > inner && inner >= 0.0 && young > 0.0 && poisson > -1.0 && density >= 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                "tube_section: needs outer > inner >= 0, young > 0, poisson > -1, density >= 0; "
                "got " +
                    text(outer) + ", " + text(inner) + ", " + text(young) + ", " + text(poisson) +
                    ", " + text(density));
  }
  const double area = 0.25 * pi * (outer * outer - inner * inner);
  BeamSection s;
  s.axial = young * area;
  s.bending_2 = s.bending_3 = young * pi / 64.0 * (std::pow(outer, 4) - std::pow(inner, 4));
  s.torsion = s.bending_2 / (1.0 + poisson);  // J = 2 I, G = E/2(1 + nu)
  s.radius = 0.5 * outer;
  s.line_density = density * area;
  return s;
}

BeamSection rod_section(double diameter, double bending, double poisson, double density) {
  const double young = bending / (pi / 64.0 * std::pow(diameter, 4));
  if (!(bending > 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                "rod_section: bending = " + text(bending) + " is not positive");
  }
  return tube_section(diameter, 0.0, young, poisson, density);
}

BeamDevice::BeamDevice(std::string name, Points nodes, std::vector<BeamSection> sections,
                       std::vector<Contact> contacts, std::vector<Mat3> frames) {
  const std::string who = of_device(name);
  check_nodes(who, nodes);
  const auto count = std::size_t(nodes.rows()), elements = count - 1;
  if (sections.size() == 1) sections.resize(elements, sections.front());
  if (sections.size() != elements) {
    throw Error(ErrorCode::size_mismatch, who + std::to_string(sections.size()) + " sections for " +
                                              std::to_string(elements) + " elements");
  }
  for (std::size_t e = 0; e < elements; ++e) {
    check_section(who + "section of element " + std::to_string(e) + ": ", sections[e]);
  }
  if (frames.empty()) {
    const std::vector<Vec3> tangents = polyline_tangents(nodes);
    frames = transported_frames(tangents, any_frame(tangents.front()));
  }
  if (frames.size() != count) {
    throw Error(ErrorCode::size_mismatch, who + std::to_string(frames.size()) + " frames for " +
                                              std::to_string(count) + " nodes");
  }
  check_frames(who, nodes, frames);
  auto data = std::make_shared<Data>();
  data->arcs = Eigen::VectorXd::Zero(Eigen::Index(count));
  for (std::size_t e = 0; e < elements; ++e) {
    const auto i = Eigen::Index(e);
    const ElementPose pose{nodes.row(i), nodes.row(i + 1), frames[e], frames[e + 1], 0};
    data->arcs[i + 1] = data->arcs[i] + BeamElement(sections[e], pose).length();
  }
  check_contacts(who, contacts, data->arcs[Eigen::Index(elements)]);
  data->name = std::move(name);
  data->nodes = std::move(nodes);
  data->sections = std::move(sections);
  data->contacts = std::move(contacts);
  data->frames = std::move(frames);
  m_data = std::move(data);
}

BeamDevice BeamDevice::straight(std::string name, double length, Index elements,
                                const std::vector<SectionInterval>& intervals,
                                std::vector<Contact> contacts) {
  const std::string who = of_device(name);
  if (!std::isfinite(length) || !(length > 0.0) || elements < 1) {
    throw Error(ErrorCode::invalid_argument,
                who + "needs a positive length and at least one element; got " + text(length) +
                    " mm and " + std::to_string(elements));
  }
  Points nodes = Points::Zero(elements + 1, 3);
  std::vector<BeamSection> sections;
  for (Index e = 0; e < elements; ++e) {
    nodes(e + 1, 0) = length * (e + 1) / elements;
    const double middle = length * (e + 0.5) / elements;
    const auto holds = [middle](const SectionInterval& i) {
      return i.from <= middle && middle <= i.to;
    };
    const auto found = std::find_if(intervals.begin(), intervals.end(), holds);
    if (found == intervals.end()) {
      throw Error(ErrorCode::invalid_argument,
                  who + "no section at " + text(middle) + " mm from the tip");
    }
    sections.push_back(found->section);
  }
  std::vector<Mat3> frames(std::size_t(elements) + 1, Mat3::Identity());
  return BeamDevice(std::move(name), std::move(nodes), std::move(sections), std::move(contacts),
                    std::move(frames));
}

BeamDevice BeamDevice::straight(std::string name, double length, Index elements,
                                const BeamSection& section, std::vector<Contact> contacts) {
  const SectionInterval whole{0.0, length, section};
  return straight(std::move(name), length, elements, {whole}, std::move(contacts));
}

const std::string& BeamDevice::name() const { return m_data->name; }
Index BeamDevice::node_count() const { return Index(m_data->nodes.rows()); }
Index BeamDevice::element_count() const { return Index(m_data->sections.size()); }
const Points& BeamDevice::nodes() const { return m_data->nodes; }
const std::vector<Mat3>& BeamDevice::frames() const { return m_data->frames; }
const std::vector<Contact>& BeamDevice::contacts() const { return m_data->contacts; }
const Eigen::VectorXd& BeamDevice::arcs() const { return m_data->arcs; }
double BeamDevice::length() const { return m_data->arcs[m_data->arcs.size() - 1]; }

const BeamSection& BeamDevice::section(Index element) const {
  if (element < 0 || element >= element_count()) {
    throw Error(ErrorCode::index_out_of_range, of_device(name()) + "there is no element " +
                                                   std::to_string(element) + " of " +
                                                   std::to_string(element_count()));
  }
  return m_data->sections[std::size_t(element)];
}

Index BeamDevice::element_at(double arc) const {
  const double* first = m_data->arcs.data();
  const auto above = std::lower_bound(first + 1, first + element_count(), arc);
  return Index(above - first) - 1;
}

}  // namespace brainshift
