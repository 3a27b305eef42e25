/* Solves what a host has recorded by brs_stepper_record() once more, to the same bits in the same build:
 * what to send with a bug report, and what to do with one.
 *
 * Build:  cc replay.c $(pkg-config --cflags --libs brainshift_c) -o replay
 * Run:    replay FILE
 * Prints: the build, and status, message and certificate of the solve
 */
#include <stdio.h>
#include <stdlib.h>

#include "brainshift/c/brainshift.h"

static brs_context* context;

static brs_status check(brs_status status) {
  if (status < 0) {
    fprintf(stderr, "%s: %s\n", brs_status_name(status), brs_context_message(context));
    exit(EXIT_FAILURE);
  }
  return status;
}

static uint8_t* read_file(const char* path, int64_t* count) {
  FILE* file = fopen(path, "rb");
  uint8_t* bytes = NULL;
  long size = -1;
  if (file && fseek(file, 0, SEEK_END) == 0) size = ftell(file);
  if (size > 0 && fseek(file, 0, SEEK_SET) == 0) bytes = malloc((size_t)size);
  if (!bytes || fread(bytes, 1, (size_t)size, file) != (size_t)size) {
    fprintf(stderr, "%s cannot be read\n", path);
    exit(EXIT_FAILURE);
  }
  fclose(file);
  *count = size;
  return bytes;
}

int main(int argc, char** argv) {
  int64_t count;
  uint8_t* bytes;
  brs_stepper* stepper;
  brs_solve_report report;
  brs_status status;
  if (argc != 2) {
    fprintf(stderr, "usage: replay FILE\n");
    return EXIT_FAILURE;
  }
  printf("%s\n", brs_build_info());
  check(brs_context_create(BRS_VERSION, &context));
  bytes = read_file(argv[1], &count);
  check(brs_stepper_replay(context, bytes, count, &stepper));
  free(bytes);
  check(brs_solve_report_init(&report, sizeof report));
  status = check(brs_stepper_solve_static(stepper, &report));
  printf("%s: %s\n", brs_status_name(status), brs_context_message(context));
  printf("load %.3f, residual %.1e, min J %.3f, %d iterations, %d load steps, %.3f s\n",
         report.load_factor, report.residual, report.smallest_jacobian, (int)report.iterations,
         (int)report.load_steps, report.seconds);
  brs_stepper_destroy(stepper);
  brs_context_destroy(context);
  return EXIT_SUCCESS;
}
