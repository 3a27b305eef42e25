// Bad input ends the program with one sentence that names the culprit, a non-zero exit, and nothing
// written.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include <gtest/gtest.h>

#include "brainshift/io.hpp"
#include "head_scene.hpp"

namespace dbs {
namespace {

namespace fs = std::filesystem;

class Refusals : public ::testing::Test {
 protected:
  Refusals() : m_folder(fs::temp_directory_path() / ("brainshift_refusals_" + unique())) {
    fs::create_directories(m_folder / "head");
    fs::copy(HEAD_FOLDER, m_folder / "head", fs::copy_options::recursive);
  }
  ~Refusals() override { fs::remove_all(m_folder); }

  // Runs dbs on the copied head; expects failure and one line on stderr that holds every fragment.
  void expect_refusal(const std::string& options, const std::vector<std::string>& fragments) {
    const fs::path out = m_folder / "out", err = m_folder / "stderr";
    const std::string command = std::string(DBS_PROGRAM) + " --quiet --head " +
                                (m_folder / "head").string() + " --out " + out.string() + " " +
                                options + " > " + (m_folder / "stdout").string() + " 2> " +
                                err.string();
    const int status = std::system(command.c_str());
    EXPECT_NE(status, 0) << options;
    std::ifstream file(err);
    std::stringstream text;
    text << file.rdbuf();
    for (const std::string& fragment : fragments) {
      EXPECT_NE(text.str().find(fragment), std::string::npos) << "'" << text.str() << "'";
    }
    const std::string said = text.str();
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << "'" << said << "'";
    EXPECT_FALSE(fs::exists(out)) << options;
  }

  void change_brain(const std::function<void(io::Grid&)>& change) {
    const std::string path = (m_folder / "head" / "brain.vtu").string();
    io::Grid grid = io::read_vtu(path);
    change(grid);
    io::write_vtu(path, grid);
  }

  fs::path m_folder;

 private:
  static std::string unique() {
    return ::testing::UnitTest::GetInstance()->current_test_info()->name() +
           std::to_string(std::hash<std::string>()(HEAD_FOLDER) % 1000);
  }
};

TEST_F(Refusals, NameUnknownLawsAndImpossibleParameters) {
  expect_refusal("--law rubber", {"unknown law 'rubber'", "corotational"});
  expect_refusal("--poisson 0.5", {"poisson", "0.5"});
  expect_refusal("--young 0", {"young"});
  expect_refusal("--csf-density=-1", {"density"});
  expect_refusal("--right 20pints", {"20pints"});
}

TEST_F(Refusals, NameVolumesOfFluidThatCannotBe) {
  expect_refusal("--right=-5mL", {"-5", "negative"});
  expect_refusal("--right 2000mL", {"1400 mL"});  // of them lost early
  expect_refusal("--right 10mL --left 5000mL-air", {"mL"});
  expect_refusal("--right nanmL", {"nan"});
  expect_refusal("--right 20mL --left 30mm", {"different kinds", "20mL", "30mm"});
}

TEST_F(Refusals, NameTrajectoriesThatCannotBe) {
  expect_refusal("--target-right 11 -12 90", {"right", "(11.00 -12.00 90.00)", "not in tissue"});
  expect_refusal("--target-right 300 0 0", {"right", "not in tissue"});
  expect_refusal("--target-right -11 -12 -8", {"right", "other half"});
  expect_refusal("--lateral=-60", {"crosses the midline"});
  expect_refusal("--sides left --lateral=-60", {"left", "crosses the midline"});
  expect_refusal("--sagittal 200", {"leads downwards"});
  expect_refusal("--target VIM", {"landmark 'VIM_"});
  expect_refusal("--target-left nan 0 0 --sides left", {"left", "not finite"});
}

TEST_F(Refusals, NameDevicesThatCannotBe) {
  expect_refusal("--lead cannula", {"'cannula' is no electrode"});
  expect_refusal("--lead spaghetti", {"'spaghetti'", "3389"});
  expect_refusal("--test-electrode spaghetti", {"'spaghetti'"});
  expect_refusal("--bending=-1", {"--bending"});
  expect_refusal("--friction=-1", {"--friction"});
  expect_refusal("--slack nan", {"--slack"});
  expect_refusal("--cannula-depth 60", {"--cannula-depth"});
}

TEST_F(Refusals, NameAMissingFile) {
  fs::remove(m_folder / "head" / "falx.vtp");
  expect_refusal("", {"falx.vtp"});
}

TEST_F(Refusals, NameAnInvertedTet) {
  change_brain([](io::Grid& g) { std::swap(g.tets(17, 0), g.tets(17, 1)); });
  expect_refusal("", {"tet 17", "negative volume"});
}

TEST_F(Refusals, NameAnOrphanNode) {
  change_brain([](io::Grid& g) {
    g.points.conservativeResize(g.points.rows() + 1, 3);
    g.points.bottomRows(1).setConstant(5.0);
    for (io::Field& f : g.node_fields) {
      f.values.conservativeResize(f.values.rows() + 1, f.values.cols());
      f.values.bottomRows(1).setZero();
    }
  });
  expect_refusal("", {"node " + std::to_string(shipped_head().brain.node_count())});
}

TEST_F(Refusals, NameTheFileThatHoldsNaN) {
  const fs::path path = m_folder / "head" / "falx.vtp";
  std::ofstream(path) << "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">"
                         "<PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points>"
                         "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
                         "0 0 0 1 nan 0 0 1 0</DataArray></Points><Polys>"
                         "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2"
                         "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3"
                         "</DataArray></Polys></Piece></PolyData></VTKFile>";
  expect_refusal("", {"falx.vtp"});
}

TEST_F(Refusals, NameAnOpenCavity) {
  const std::string path = (m_folder / "head" / "cavity.vtp").string();
  io::Grid grid = io::read_vtp(path);
  grid.triangles = grid.triangles.bottomRows(grid.triangles.rows() - 1).eval();
  for (io::Field& f : grid.cell_fields) {
    f.values = f.values.bottomRows(f.values.rows() - 1).eval();
  }
  io::write_vtp(path, grid);
  expect_refusal("", {"edge"});
}

TEST_F(Refusals, NameALandmarkThatIsMissing) {
  std::ofstream(m_folder / "head" / "head.json")
      << R"({"frame": "RAS", "units": "mm", "landmarks": {"AC": [0, 0, 0]}})";
  expect_refusal("", {"head.json", "PC"});
}

}  // namespace
}  // namespace dbs
