/* Sets the clock of a program ahead: preloaded before the C library, it adds CLOCK_AHEAD seconds to the time of day. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <time.h>

int clock_gettime(clockid_t clock, struct timespec *now) {
    __typeof__(&clock_gettime) real = (__typeof__(&clock_gettime)) dlsym(RTLD_NEXT, "clock_gettime");
    int failed = real(clock, now);
    const char *ahead = getenv("CLOCK_AHEAD");
    if (clock == CLOCK_REALTIME && ahead != NULL) {
        now->tv_sec += atoll(ahead);
    }
    return failed;
}
