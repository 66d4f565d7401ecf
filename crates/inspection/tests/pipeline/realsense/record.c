/* Records frames of a software camera: record LIBRARY FILE FRAMES MODEL. FILE gets the ending that the library accepts; MODEL
 * is the lens model. The frames are those of camera.c, 16 by 12 pixels, in half millimetres. */
#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 16, HEIGHT = 12, DEPTH = 1, Z16 = 1, DEPTH_UNITS = 28, NAME = 0, SERIAL_NUMBER = 1, SYSTEM_TIME = 1 };

typedef struct { int width, height; float ppx, ppy, fx, fy; int model; float coeffs[5]; } Intrinsics;
typedef struct { int type, index, id, width, height, rate, bytes, format; Intrinsics intrinsics; } Stream;
typedef struct {
    void *pixels; void (*delete)(void *); int stride, bytes; double time; int clock, number; const void *profile; float units;
} Frame;

static void *library, *error;

static void *function(const char *name) {
    void *found = dlsym(library, name);
    if (found == NULL)
        exit((fprintf(stderr, "%s\n", dlerror()), 2));
    return found;
}

static void check(const char *what) {
    if (error != NULL)
        exit((fprintf(stderr, "%s: %s\n", what, ((const char *(*)(void *))function("rs2_get_error_message"))(error)), 2));
}

static void on_frame(void *frame, void *unused) {
    (void)unused;
    ((void (*)(void *))function("rs2_release_frame"))(frame);
}

/* The device that writes to the file. Newer libraries refuse the older ending; older ones would take either. */
static void *recorder(void *device, const char *file) {
    static const char *const endings[] = { ".bag", ".db3" };
    for (int k = 0; k < 2; k++) {
        char path[4096];
        void *made;
        snprintf(path, sizeof path, "%s%s", file, endings[k]);
        error = NULL;
        made = ((void *(*)(void *, const char *, void **))function("rs2_create_record_device"))(device, path, &error);
        if (error == NULL)
            return made;
    }
    check("record");
    return NULL;
}

int main(int num, char **words) {
    void *device, *sensor, *profile, *recording, *sensors, *its_sensor, *profiles, *its_profile;
    int model;
    if (num != 5 || (library = dlopen(words[1], RTLD_LAZY)) == NULL)
        exit((fprintf(stderr, "%s\n", dlerror()), 2));
    model = atoi(words[4]);
    device = ((void *(*)(void **))function("rs2_create_software_device"))(&error);
    check("device");
    ((void (*)(void *, int, const char *, void **))function("rs2_software_device_register_info"))(device, NAME, "Software camera", &error);
    check("name");
    ((void (*)(void *, int, const char *, void **))function("rs2_software_device_register_info"))(device, SERIAL_NUMBER, "S1", &error);
    check("serial number");
    sensor = ((void *(*)(void *, const char *, void **))function("rs2_software_device_add_sensor"))(device, "Stereo Module", &error);
    check("sensor");
    Stream stream = { DEPTH, 0, 1, WIDTH, HEIGHT, 30, 2, Z16,
        { WIDTH, HEIGHT, 7.5F, 5.25F, 20.0F, 21.0F, model, { 0.125F, -0.0625F, 0.001F, -0.002F, 0.015625F } } };
    profile = ((void *(*)(void *, Stream, void **))function("rs2_software_sensor_add_video_stream"))(sensor, stream, &error);
    check("stream");
    ((void (*)(void *, int, float, void **))function("rs2_software_sensor_add_read_only_option"))(sensor, DEPTH_UNITS, 0.0005F, &error);
    check("units");

    recording = recorder(device, words[2]);
    sensors = ((void *(*)(void *, void **))function("rs2_query_sensors"))(recording, &error);
    check("sensors");
    its_sensor = ((void *(*)(void *, int, void **))function("rs2_create_sensor"))(sensors, 0, &error);
    check("its sensor");
    profiles = ((void *(*)(void *, void **))function("rs2_get_stream_profiles"))(its_sensor, &error);
    check("profiles");
    its_profile = ((void *(*)(void *, int, void **))function("rs2_get_stream_profile"))(profiles, 0, &error);
    check("its profile");
    ((void (*)(void *, void *, void **))function("rs2_open"))(its_sensor, its_profile, &error);
    check("open");
    ((void (*)(void *, void *, void *, void **))function("rs2_start"))(its_sensor, (void *)on_frame, NULL, &error);
    check("start");
    for (int k = 0; k < atoi(words[3]); k++) {
        uint16_t *pixels = malloc(2 * WIDTH * HEIGHT);
        for (int row = 0; row < HEIGHT; row++)
            for (int column = 0; column < WIDTH; column++)
                pixels[row * WIDTH + column] = (uint16_t)(column == 5 && row == 7 ? k + 1
                    : column == 9 && row == 3 ? 0 : 1000 + 3 * column + row);
        Frame frame = { pixels, free, 2 * WIDTH, 2, 1700000000000.0 + 100.0 * k, SYSTEM_TIME, k + 1, profile, 0.0005F };
        ((void (*)(void *, Frame, void **))function("rs2_software_sensor_on_video_frame"))(sensor, frame, &error);
        check("frame");
    }
    /* Wait, because the library writes on a thread of its own. */
    usleep(200000);
    ((void (*)(void *, void **))function("rs2_stop"))(its_sensor, &error);
    check("stop");
    ((void (*)(void *, void **))function("rs2_close"))(its_sensor, &error);
    check("close");
    ((void (*)(void *))function("rs2_delete_stream_profiles_list"))(profiles);
    ((void (*)(void *))function("rs2_delete_sensor"))(its_sensor);
    ((void (*)(void *))function("rs2_delete_sensor_list"))(sensors);
    ((void (*)(void *))function("rs2_delete_device"))(recording);
    ((void (*)(void *))function("rs2_delete_sensor"))(sensor);
    ((void (*)(void *))function("rs2_delete_device"))(device);
    return 0;
}
