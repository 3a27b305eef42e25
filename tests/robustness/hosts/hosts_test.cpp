// A library is a guest: what belongs to the process is left as it was, and works as it does without.
#include <dlfcn.h>
#include <fenv.h>
#include <pthread.h>
#include <sys/mman.h>
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

// The BLAS is whichever the host has loaded. OpenBLAS's serial build ignores how many threads it is told to
// use; of one with threads the same bits are not promised (docs/decisions/threads.md), the answer is.
TEST(Hosts, H6_a_blas_told_to_use_threads) {
  const auto use = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  const auto kind = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_parallel"));
  if (!use || !kind) GTEST_SKIP() << "the BLAS in use is not OpenBLAS";
  const Points expected = solved(8);
  for (const int threads : {4, 2, 1}) {
    use(threads);
    const Points found = solved(8);
    EXPECT_LE(largest_distance(found, expected), 1e-9) << threads;
    EXPECT_TRUE(kind() != 0 || same_bits(found, expected)) << threads;
  }
}

// Runs `call` on a stack of its own and tells how much of it was written to. Not every byte that is
// reserved is: an array of which nothing is used does not count here, nor does it need memory.
std::size_t stack_used_by(const std::function<void()>& call) {
  constexpr std::size_t size = 1 << 20;
  void* stack =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  std::memset(stack, 0xa5, size);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstack(&attributes, stack, size);
  pthread_t thread;
  const auto start = [](void* f) -> void* {
    (*static_cast<const std::function<void()>*>(f))();
    return nullptr;
  };
  const int failed = pthread_create(&thread, &attributes, start,
                                    const_cast<void*>(static_cast<const void*>(&call)));
  EXPECT_EQ(failed, 0);
  if (failed == 0) pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
  const auto* bytes = static_cast<const unsigned char*>(stack);
  std::size_t untouched = 0;
  while (untouched < size && bytes[untouched] == 0xa5) ++untouched;
  munmap(stack, size);
  return size - untouched;
}

// Beyond what a thread has on its stack by itself (thread-local storage, half of 64 KiB with OpenBLAS and
// OpenMP): tissue needs less than 32 KiB, so that 64 KiB do. Devices need more, for the second derivatives
// of a beam element are 36 KiB of numbers on the stack: such a thread should have 128 KiB. The build without
// CHOLMOD puts blocks of its dense products there besides.
TEST(Hosts, P13_a_thread_with_a_small_stack) {
  const std::size_t nothing = stack_used_by([] {});
  const std::size_t tissue = stack_used_by([] { solved(); }) - nothing;
  const std::size_t quadratic_tets = stack_used_by([] {
                                       Stepper stepper(quadratic(busy_scene(2, 0.3)));
                                       stepper.csf().set_lost_volume(0, 9000.0);
                                       EXPECT_TRUE(stepper.solve_static().converged());
                                     }) -
                                     nothing;
  const std::size_t devices = stack_used_by([] { run_procedure(); }) - nothing;
  std::printf(
      "P13: bytes of stack: a thread %zu; tissue %zu, quadratic %zu, with devices %zu more\n",
      nothing, tissue, quadratic_tets, devices);
  EXPECT_GT(tissue, 1000u);
  const std::size_t more = WITH_CHOLMOD ? 0 : 32u * 1024u;
  EXPECT_LE(tissue, more + 32u * 1024u);
  EXPECT_LE(quadratic_tets, more + 32u * 1024u);
  EXPECT_LE(devices, more + 64u * 1024u);
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
  keep([] {  // an inverted tet, of 0.1875 mm^3
    TetShape one{Points(4, 3), Tets(1, 4)};
    one.points << 0, 0, 0, 1.5, 0, 0, 0, 1.5, 0, 0, 0, 0.5;
    one.tets << 0, 2, 1, 3;
    make_mesh(one);
  });
  keep([] {
    Points points = Points::Zero(4, 3);
    points.row(2) << 0.625, std::nan(""), 1234.5;
    Mesh(points, Tets::Zero(1, 4));
  });
  const auto surface = [](double spacing) {
    const auto wall = make_box_surface({1250.5, 10, 10});
    SurfaceOptions options;
    options.grid_spacing = spacing;
    Surface::cavity(wall.points, wall.triangles, options);
  };
  keep([&] { surface(-0.875); });
  keep([&] { surface(0.03125); });
  keep([&] { s.insert(make_device("3389", 40.0), {Vec3(-9.25, 15, 9), Vec3::UnitZ()}, {0.0}); });
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

// The C library's German, made here where it is not installed; in force as long as this lives.
class LocaleFolder {
 public:
  LocaleFolder()
      : m_path(std::filesystem::temp_directory_path() /
               ("brainshift_locale_" + std::to_string(getpid()))) {
    if (std::setlocale(LC_ALL, "de_DE.UTF-8")) {
      m_made = true;
      return;
    }
    std::filesystem::create_directory(m_path);
    const std::string make = "localedef -c -i de_DE -f UTF-8 " + (m_path / "de_DE.UTF-8").string();
    if (std::system((make + " >/dev/null 2>&1").c_str()) != 0) return;
    setenv("LOCPATH", m_path.c_str(), 1);
    m_made = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
    unsetenv("LOCPATH");
  }
  ~LocaleFolder() {
    std::setlocale(LC_ALL, "C");
    std::filesystem::remove_all(m_path);
  }
  LocaleFolder(const LocaleFolder&) = delete;
  LocaleFolder& operator=(const LocaleFolder&) = delete;
  bool made() const { return m_made; }

 private:
  std::filesystem::path m_path;
  bool m_made = false;
};

TEST(Hosts, P11_a_decimal_comma_changes_nothing) {
  const std::string plain = said();
  EXPECT_NE(plain.find("0.75"), std::string::npos);
  EXPECT_NE(plain.find("1234.5"), std::string::npos);
  for (const char* number : {"-0.188 mm^3", "(0.625, ", "-0.875", "0.03125", "(-9.25 "})
    EXPECT_NE(plain.find(number), std::string::npos) << number << " in\n" << plain.substr(0, 3000);
  const std::locale old = std::locale::global(std::locale(std::locale(), new DecimalComma));
  EXPECT_EQ(said(), plain);
  std::locale::global(old);
  const LocaleFolder folder;
  if (!folder.made())
    GTEST_SKIP() << "no localedef, or no sources of locales: only C++'s was tried";
  EXPECT_EQ(said(), plain);
  EXPECT_STREQ(std::localeconv()->decimal_point, ",");
}

}  // namespace
}  // namespace brainshift::test
