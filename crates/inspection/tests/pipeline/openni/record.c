/* Records frames of the first camera: record LIBRARY FILE.oni FRAMES. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void *library;

static void *function(const char *name) {
    void *found = dlsym(library, name);
    if (found == NULL)
        exit((fprintf(stderr, "%s\n", dlerror()), 2));
    return found;
}

static void check(const char *what, int code) {
    if (code != 0)
        exit((fprintf(stderr, "%s: %d\n", what, code), 2));
}

int main(int num, char **words) {
    void *device, *stream, *recorder, *frame;
    if (num != 4 || (library = dlopen(words[1], RTLD_NOW)) == NULL)
        exit((fprintf(stderr, "%s\n", dlerror()), 2));
    check("initialize", ((int (*)(int))function("oniInitialize"))(2002));
    check("open", ((int (*)(const char *, void **))function("oniDeviceOpen"))(NULL, &device));
    check("stream", ((int (*)(void *, int, void **))function("oniDeviceCreateStream"))(device, 3, &stream));
    check("recorder", ((int (*)(const char *, void **))function("oniCreateRecorder"))(words[2], &recorder));
    check("attach", ((int (*)(void *, void *, int))function("oniRecorderAttachStream"))(recorder, stream, 0));
    check("record", ((int (*)(void *))function("oniRecorderStart"))(recorder));
    /* Wait until the recorder's thread has started, so that it gets the first frames. */
    usleep(200000);
    check("start", ((int (*)(void *))function("oniStreamStart"))(stream));
    for (int k = 0; k < atoi(words[3]); k++) {
        check("read", ((int (*)(void *, void **))function("oniStreamReadFrame"))(stream, &frame));
        ((void (*)(void *))function("oniFrameRelease"))(frame);
    }
    ((void (*)(void *))function("oniStreamStop"))(stream);
    check("destroy", ((int (*)(void **))function("oniRecorderDestroy"))(&recorder));
    ((void (*)(void *))function("oniStreamDestroy"))(stream);
    ((int (*)(void *))function("oniDeviceClose"))(device);
    ((void (*)(void))function("oniShutdown"))();
    return 0;
}
