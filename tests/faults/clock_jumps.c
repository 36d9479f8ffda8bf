/* Sets the computer's clock for one program: loaded before it (LD_PRELOAD), adds to CLOCK_REALTIME what CLOCK_JUMPS says,
   "SECONDS:JUMP SECONDS:JUMP ...": from so many seconds after the program's start on, so many seconds. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <sys/time.h>
#include <time.h>

typedef int (*clock_function)(clockid_t, struct timespec*);

static clock_function real_clock(void) {
  static clock_function found;
  if (!found) found = (clock_function)dlsym(RTLD_NEXT, "clock_gettime");
  return found;
}

static long jump_now(void) {
  static double start = -1.0;
  struct timespec now;
  real_clock()(CLOCK_MONOTONIC, &now);
  const double seconds = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
  if (start < 0.0) start = seconds;
  long jump = 0;
  char* at = getenv("CLOCK_JUMPS");
  while (at && *at) {
    char* next;
    const double when = strtod(at, &next);
    if (next == at || *next != ':') break;
    const long by = strtol(next + 1, &at, 10);
    if (seconds - start >= when) jump = by;
  }
  return jump;
}

__attribute__((constructor)) static void begin(void) { jump_now(); }

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int result = real_clock()(clock, now);
  if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) now->tv_sec += jump_now();
  return result;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  struct timespec time;
  (void)zone;
  clock_gettime(CLOCK_REALTIME, &time);
  now->tv_sec = time.tv_sec;
  now->tv_usec = time.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* to) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  if (to) *to = now.tv_sec;
  return now.tv_sec;
}
