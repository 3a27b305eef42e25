// Writes one tet and reads it back.
#include <cstdio>

#include <brainshift/io.hpp>

int main() {
  using namespace brainshift;
  io::Grid grid;
  grid.points = Points::Identity(4, 3);
  grid.tets.resize(1, 4);
  grid.tets << 3, 0, 1, 2;
  io::write_vtu("tet.vtu", grid);
  std::printf("read back %d tet\n", int(io::read_vtu("tet.vtu").tets.rows()));
}
