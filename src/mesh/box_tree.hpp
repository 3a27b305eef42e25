// Tree of axis-aligned boxes over numbered items (tets, triangles), for point queries.
//
// A tree, not a uniform grid: brain meshes are fine along the track and coarse far away, and a grid
// that suits one of the two is slow in the other.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "brainshift/types.hpp"

namespace brainshift {

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void include(const Vec3& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void include(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  double squared_distance(const Vec3& point) const {  // mm^2; 0 inside
    return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
  }
};

class BoxTree {
 public:
  explicit BoxTree(const std::vector<Box>& boxes) : m_items(boxes.size()) {
    std::iota(m_items.begin(), m_items.end(), Index(0));
    if (!boxes.empty()) build(boxes, 0, Index(boxes.size()));
  }

  // Items in the order of the leaves: item data stored in this order is read contiguously.
  const Indices& items() const { return m_items; }

  // Calls visit(position in items()) for all leaves within the squared distance of the point that
  // visit returned last (first: `bound`); nearer leaves first. Boxes at exactly the bound count.
  template <class Visit>
  void visit_near(const Vec3& point, double bound, Visit&& visit) const {
    if (m_nodes.empty()) return;
    struct Entry {
      Index node;
      double distance;
    };
    Entry stack[max_depth];
    int size = 0;
    stack[size++] = {0, m_nodes[0].box.squared_distance(point)};
    while (size > 0) {
      const Entry entry = stack[--size];
      if (entry.distance > bound) continue;
      const Node& node = m_nodes[std::size_t(entry.node)];
      if (node.count > 0) {
        for (Index i = node.first; i < node.first + node.count; ++i) bound = visit(i);
        continue;
      }
      Entry near{entry.node + 1, m_nodes[std::size_t(entry.node) + 1].box.squared_distance(point)};
      Entry far{node.first, m_nodes[std::size_t(node.first)].box.squared_distance(point)};
      if (far.distance < near.distance) std::swap(near, far);
      if (far.distance <= bound) stack[size++] = far;
      if (near.distance <= bound) stack[size++] = near;
    }
  }

 private:
  // Median splits of at most 2^31 items: the stack never holds more than one entry per level, + 1.
  static constexpr int max_depth = 64;
  static constexpr Index leaf_size = 4;

  struct Node {
    Box box;
    Index first;  // leaf: first item; else: the second child (the first child is the next node)
    Index count;  // leaf: number of items; else 0
  };

  Index build(const std::vector<Box>& boxes, Index begin, Index end) {
    const Index number = Index(m_nodes.size());
    m_nodes.push_back({Box(), begin, end - begin});
    Box all, centres;
    for (Index i = begin; i < end; ++i) {
      const Box& box = boxes[std::size_t(m_items[std::size_t(i)])];
      all.include(box);
      centres.include(Vec3(box.low + box.high));
    }
    m_nodes[std::size_t(number)].box = all;
    if (end - begin <= leaf_size) return number;

    int axis = 0;
    (centres.high - centres.low).maxCoeff(&axis);
    const Index middle = begin + (end - begin) / 2;
    // Ties are broken by number, so that the tree does not depend on the standard library.
    std::nth_element(m_items.begin() + begin, m_items.begin() + middle, m_items.begin() + end,
                     [&](Index a, Index b) {
                       const Box &p = boxes[std::size_t(a)], &q = boxes[std::size_t(b)];
                       const double x = p.low[axis] + p.high[axis], y = q.low[axis] + q.high[axis];
                       return x < y || (x == y && a < b);
                     });
    build(boxes, begin, middle);
    const Index second = build(boxes, middle, end);
    m_nodes[std::size_t(number)].first = second;
    m_nodes[std::size_t(number)].count = 0;
    return number;
  }

  Indices m_items;
  std::vector<Node> m_nodes;
};

}  // namespace brainshift
