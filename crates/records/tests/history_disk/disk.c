/* Simulates a failing disk: preloaded before the C library, it makes a call that changes a file fail.
 *
 * DISK_FILES is a part of the paths of the files whose calls fail.
 * DISK_FAULT is "KIND NUMBER": the kind of fault, and the number of the call at which it occurs.
 *   full    half of the data is written, and nothing from then on
 *   broken  an input/output error at this call and all later ones
 *   once    an input/output error at this call only
 *   killed  half of the data is written, and the program is killed
 * DISK_MARK is a file that is created when the fault occurs. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

#define REAL(name) ((__typeof__(&name)) dlsym(RTLD_NEXT, #name))

static atomic_int num_calls;

static int is_failing(const char *path) {
    const char *files = getenv("DISK_FILES");
    return files != NULL && strstr(path, files) != NULL;
}

static int is_open_failing(int file) {
    char link[64], path[PATH_MAX];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    if (length < 0) {
        return 0;
    }
    path[length] = 0;
    return is_failing(path);
}

/* 1 if the fault begins at this call, 2 if it began earlier, 0 if the call succeeds. */
static int fails(const char **kind) {
    static char words[64];
    const char *wanted = getenv("DISK_FAULT");
    int at = 0;
    if (wanted == NULL || sscanf(wanted, "%63s %d", words, &at) != 2) {
        return 0;
    }
    *kind = words;
    int number = atomic_fetch_add(&num_calls, 1) + 1;
    if (number < at || (number > at && strcmp(words, "once") == 0)) {
        return 0;
    }
    int mark = REAL(open)(getenv("DISK_MARK"), O_CREAT | O_WRONLY, 0600);
    REAL(close)(mark);
    return number == at ? 1 : 2;
}

/* Kills the program, or sets errno and returns the result of a failed call. */
static int failed(const char *kind) {
    if (strcmp(kind, "killed") == 0) {
        raise(SIGKILL);
    }
    errno = strcmp(kind, "full") == 0 ? ENOSPC : EIO;
    return -1;
}

/* Number of bytes that still reach the disk; -1 if the call does not fail. */
static ssize_t arriving(int file, size_t size, const char **kind) {
    int turn = is_open_failing(file) ? fails(kind) : 0;
    if (turn == 0) {
        return -1;
    }
    int is_partial = strcmp(*kind, "full") == 0 || strcmp(*kind, "killed") == 0;
    return turn == 1 && is_partial ? (ssize_t) (size / 2) : 0;
}

ssize_t write(int file, const void *bytes, size_t size) {
    const char *kind = "";
    ssize_t most = arriving(file, size, &kind);
    if (most < 0) {
        return REAL(write)(file, bytes, size);
    }
    ssize_t written = most > 0 ? REAL(write)(file, bytes, (size_t) most) : 0;
    return written > 0 && strcmp(kind, "full") == 0 ? written : failed(kind);
}

static ssize_t write_at(int file, const void *bytes, size_t size, off64_t place) {
    const char *kind = "";
    ssize_t most = arriving(file, size, &kind);
    if (most < 0) {
        return REAL(pwrite64)(file, bytes, size, place);
    }
    ssize_t written = most > 0 ? REAL(pwrite64)(file, bytes, (size_t) most, place) : 0;
    return written > 0 && strcmp(kind, "full") == 0 ? written : failed(kind);
}

ssize_t pwrite(int file, const void *bytes, size_t size, off_t place) {
    return write_at(file, bytes, size, place);
}

ssize_t pwrite64(int file, const void *bytes, size_t size, off64_t place) {
    return write_at(file, bytes, size, place);
}

#define OF_OPEN_FILE(name, parameters, arguments)                      \
    int name parameters {                                              \
        const char *kind = "";                                         \
        if (is_open_failing(file) && fails(&kind)) {                   \
            return failed(kind);                                       \
        }                                                              \
        return REAL(name) arguments;                                   \
    }

OF_OPEN_FILE(fsync, (int file), (file))
OF_OPEN_FILE(fdatasync, (int file), (file))
OF_OPEN_FILE(ftruncate, (int file, off_t size), (file, size))
OF_OPEN_FILE(ftruncate64, (int file, off64_t size), (file, size))

int unlink(const char *path) {
    const char *kind = "";
    if (is_failing(path) && fails(&kind)) {
        return failed(kind);
    }
    return REAL(unlink)(path);
}

/* Only calls that create a file: a full disk can still open existing ones. */
#define OPENING(name)                                                  \
    int name(const char *path, int flags, ...) {                       \
        mode_t mode = 0;                                               \
        if (flags & O_CREAT) {                                         \
            va_list more;                                              \
            va_start(more, flags);                                     \
            mode = va_arg(more, mode_t);                               \
            va_end(more);                                              \
            const char *kind = "";                                     \
            if (is_failing(path) && access(path, F_OK) != 0            \
                && fails(&kind)) {                                     \
                return failed(kind);                                   \
            }                                                          \
        }                                                              \
        return REAL(name)(path, flags, mode);                          \
    }

OPENING(open)
OPENING(open64)
