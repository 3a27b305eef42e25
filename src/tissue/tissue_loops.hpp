// Loops over tets that threads share, and the sums over them in an order that threads do not change.
#pragma once

#include <vector>

#include "material/registry.hpp"
#include "threads/for_chunks.hpp"
#include "tissue/tissue.hpp"

namespace brainshift {

// Tets per chunk: long enough to be worth a thread, short enough for what a chunk keeps to stay in
// the cache.
constexpr Index tets_per_chunk = 512;

template <class Work>
void Tissue::for_tets(const Part& part, Index from, Index to, const Work& work) const {
  const LawFunctions& law = law_functions(part.material.law());
  const Lame lame = element_constants(part);
  const Index chunks = (to - from + tets_per_chunk - 1) / tets_per_chunk;
  for_chunks(m_threads, chunks, [&](Index c) {
    const ChunkRange range = chunk_range(to - from, chunks, c);
    for (Index i = range.from; i < range.to; ++i) work(law, lame, from + i);
  });
}

template <class Work>
void Tissue::for_all_tets(const Work& work) const {
  for (const Part& part : m_parts) {
    for_tets(part, 0, Index(part.tets.size()),
             [&](const LawFunctions& law, const Lame& lame, Index i) {
               work(law, lame, part.tets[std::size_t(i)]);
             });
  }
}

template <class Rows>
void Tissue::scatter(const std::vector<Rows>& forces, Points& nodal) const {
  nodal.setZero(m_mesh.node_count(), 3);
  for (std::size_t t = 0; t < forces.size(); ++t) {
    for (int a = 0; a < Rows::RowsAtCompileTime; ++a) {
      nodal.row(nodes_of(Index(t))[a]) += forces[t].row(a);
    }
  }
}

}  // namespace brainshift
