// A library is a guest: what belongs to the process is left as it was, and works as it does without.
#include <fenv.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <clocale>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <locale>

#include "brainshift/io.hpp"
#include "robustness/procedure.hpp"

namespace brainshift::test {
namespace {

Points solved(int cells = 3, StepperOptions options = {}) {
  Stepper stepper(busy_scene(cells, 0.3), std::move(options));
  stepper.csf().set_lost_volume(0, 9000.0);
  EXPECT_TRUE(stepper.solve_static().converged());
  return stepper.displacement();
}

// Runs `call` in a child; its exit status, or minus the signal that ended it.
int in_child(const std::function<bool()>& call) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(60);  // ends a child that hangs
    _exit(call() ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

std::size_t thread_count() {
  const std::filesystem::directory_iterator begin("/proc/self/task");
  return std::size_t(std::distance(begin, std::filesystem::directory_iterator()));
}

// Everything a solve may run into: balance, no balance, an error.
void run_everything() {
  run_procedure();
  Scene scene = busy_scene(2, 0.3);
  scene.balanced_reference = false;
  scene.csf.reset();
  scene.gravity *= 1e3;
  scene.materials = {{0, Material(Law::st_venant_kirchhoff, 6.0, 0.3, tissue_density)}};
  Stepper stepper(scene);
  EXPECT_FALSE(stepper.solve_static().converged());
  EXPECT_THROW(Mesh(Points(0, 3), Tets(0, 4)), Error);
}

TEST(Hosts, NothingIsPrinted) {
  std::fflush(stdout);
  std::fflush(stderr);
  std::FILE* caught = std::tmpfile();
  const int out = dup(1), err = dup(2);
  dup2(fileno(caught), 1);
  dup2(fileno(caught), 2);
  run_everything();
  std::fflush(stdout);
  std::fflush(stderr);
  dup2(out, 1);
  dup2(err, 2);
  close(out);
  close(err);
  std::fseek(caught, 0, SEEK_END);
  EXPECT_EQ(std::ftell(caught), 0);
  std::fclose(caught);
}

TEST(Hosts, NoFileIsLeftInTheWorkingFolder) {
  const auto here = std::filesystem::current_path();
  const auto empty =
      std::filesystem::temp_directory_path() / ("brainshift_empty_" + std::to_string(getpid()));
  std::filesystem::create_directory(empty);
  std::filesystem::current_path(empty);
  run_everything();
  const bool left = !std::filesystem::is_empty(empty);
  std::filesystem::current_path(here);
  std::filesystem::remove_all(empty);
  EXPECT_FALSE(left);
}

void my_handler(int) {}

TEST(Hosts, SignalHandlersAndRandomNumbersStayTheHosts) {
  srand(5);
  const int expected[] = {rand(), rand(), rand(), rand()};
  srand(5);
  EXPECT_EQ(rand(), expected[0]);
  for (const int signal : {SIGABRT, SIGTERM, SIGINT, SIGSEGV, SIGFPE})
    std::signal(signal, my_handler);
  run_everything();
  EXPECT_EQ(rand(), expected[1]);
  solved(4);
  EXPECT_EQ(rand(), expected[2]);
  for (const int signal : {SIGABRT, SIGTERM, SIGINT, SIGSEGV, SIGFPE}) {
    EXPECT_EQ(std::signal(signal, SIG_DFL), my_handler) << signal;
  }
}

TEST(Hosts, H3_no_thread_is_left) {
  const std::size_t before = thread_count();
  for (const int threads : {1, 4}) {
    StepperOptions options;
    options.threads = threads;
    solved(8, options);
    EXPECT_EQ(thread_count(), before) << threads;
  }
}

TEST(Hosts, H4_a_child_process_goes_on) {
  StepperOptions options;
  options.threads = 2;
  Stepper stepper(busy_scene(3, 0.3), options);
  stepper.csf().set_lost_volume(0, 3000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const auto kept = stepper.snapshot();
  stepper.csf().set_lost_volume(0, 6000.0);
  ASSERT_TRUE(stepper.solve_static().converged());
  const Points expected = stepper.displacement();
  stepper.restore(kept);
  EXPECT_EQ(in_child([&] {
              stepper.csf().set_lost_volume(0, 6000.0);
              return stepper.solve_static().converged() &&
                     same_bits(stepper.displacement(), expected) && solved().norm() > 0.0;
            }),
            0);
}

volatile sig_atomic_t alarms = 0;
void count_alarm(int) { alarms = alarms + 1; }

TEST(Hosts, H8_signals_that_arrive_during_a_solve) {
  const Points expected = solved(6);
  std::signal(SIGALRM, count_alarm);
  const itimerval often{{0, 1000}, {0, 1000}}, never{};
  setitimer(ITIMER_REAL, &often, nullptr);
  const Points found = solved(6);
  setitimer(ITIMER_REAL, &never, nullptr);
  std::signal(SIGALRM, SIG_DFL);
  EXPECT_GT(int(alarms), 3);
  EXPECT_TRUE(same_bits(found, expected));
}

TEST(Hosts, P12_floating_point_traps) {
  for (const int trap : {FE_DIVBYZERO, FE_INVALID, FE_OVERFLOW}) {
    EXPECT_EQ(in_child([&] {
                feenableexcept(trap);
                run_procedure();
                return !testing::Test::HasFailure();
              }),
              0)
        << (trap == FE_DIVBYZERO ? "division by zero"
            : trap == FE_INVALID ? "invalid"
                                 : "overflow");
  }
}

TEST(Hosts, P12_denormals_flushed_and_other_roundings) {
  const Points expected = solved();
  const unsigned mode = _mm_getcsr();
  _mm_setcsr(mode | 0x8040);  // flush to zero, denormals are zero
  const Points flushed = solved();
  EXPECT_EQ(_mm_getcsr() & 0x8040, 0x8040u);
  _mm_setcsr(mode);
  EXPECT_LE(largest_distance(flushed, expected), 1e-12);
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    fesetround(rounding);
    const Points found = solved();
    EXPECT_EQ(fegetround(), rounding);
    fesetround(FE_TONEAREST);
    EXPECT_LE(largest_distance(found, expected), 1e-8);
  }
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

// All that is said and written, of numbers with a fraction.
std::string said() {
  std::string text;
  const auto keep = [&](const std::function<void()>& call) {
    try {
      call();
    } catch (const Error& error) {
      text += error.what() + std::string("\n");
    }
  };
  Stepper s(busy_scene(2, 0.3));
  keep([] { Material(Law::linear, 6.0, 0.75, 1e-6); });
  keep([&] { s.step(-0.125); });
  keep([&] { s.set_damping({-1234.5, 0.0}); });
  keep([] { Csf(-0.375, FluidModel::separate, {}); });
  keep([&] { s.csf().set_air_volume(0, -1234.5); });
  keep([&] { s.csf().set_lost_volume(0, 98765.5), s.solve_static(); });
  keep([&] { s.csf().set_level(0, 98765.5), s.solve_static(); });
  keep([] {
    Scene scene = busy_scene(2, 0.3);
    const auto wall = box_wall({0.5, -5, -5}, {35, 35, 35});
    scene.constraints.obstacle("wall", surface_nodes(scene.mesh),
                               Surface::cavity(wall.points, wall.triangles));
    Stepper stepper(scene);
  });
  io::Grid grid;
  grid.points = s.mesh().nodes();
  grid.tets = s.mesh().tets();
  grid.node_fields = {{"u", Eigen::MatrixXd(solved(2)), false}};
  const std::string path = testing::TempDir() + "brainshift_locale.vtu";
  io::write_vtu(path, grid);
  EXPECT_EQ(io::read_vtu(path).node_fields[0].values, grid.node_fields[0].values);
  io::write_pvd(path, {{0.5, "a.vtu"}, {1234.5, "b.vtu"}});
  if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
    for (int c; (c = std::fgetc(file)) != EOF;) text += char(c);
    std::fclose(file);
  }
  std::remove(path.c_str());
  return text;
}

TEST(Hosts, P11_a_decimal_comma_changes_nothing) {
  const std::string plain = said();
  EXPECT_NE(plain.find("0.75"), std::string::npos);
  EXPECT_NE(plain.find("1234.5"), std::string::npos);
  const std::locale old = std::locale::global(std::locale(std::locale(), new DecimalComma));
  EXPECT_EQ(said(), plain);
  std::locale::global(old);
  bool tried = false;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "es_ES.UTF-8"}) {
    if (tried || !std::setlocale(LC_ALL, name)) continue;
    tried = true;
    EXPECT_EQ(said(), plain) << name;
    EXPECT_STREQ(std::localeconv()->decimal_point, ",");
    std::setlocale(LC_ALL, "C");
  }
  if (!tried) std::printf("no locale with a decimal comma is installed; C++'s was tried\n");
}

}  // namespace
}  // namespace brainshift::test
