/* Stubs of the librealsense 2 functions that Partsight calls, with two cameras in the state that STUB names. Makes the process
 * fail at its end if anything was not released.
 *
 * A pixel holds 1000 + 3 column + row units, except column 5, row 7: the number of the frame, column 9, row 3: no reading, and
 * column 11, row 3: the number of the camera. The rows are longer than necessary. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { DEPTH = 1, INFRARED = 3, Z16 = 1, Y8 = 9, PRESET = 12 };
enum { NUM_CAMERAS = 2, NUM_PRESETS = 4, PADDING = 64 };

typedef struct { int width, height; float ppx, ppy, fx, fy; int model; float coeffs[5]; } Intrinsics;
typedef struct { int stream, format, width, height, rate; } Profile;
typedef struct { char message[160]; } Error;
typedef struct { int camera; } Object;
typedef struct { int width, height, stride; uint8_t *data; } Frame;

static const char *const serials[NUM_CAMERAS] = { "A1", "B2" };
static const char *const presets[NUM_PRESETS] = { "Custom", "Default", NULL, "High Accuracy" };
static Profile profiles[] = {
    { INFRARED, Y8, 848, 480, 30 }, { DEPTH, Z16, 1280, 720, 30 }, { DEPTH, Z16, 640, 480, 30 }, { DEPTH, Z16, 848, 480, 90 },
    { DEPTH, Z16, 848, 480, 30 }, { DEPTH, Z16, 848, 480, 5 },
};
static int alive, opened = -1, running, number, preset = 1;
static const Profile *mode;

static int is(const char *state) {
    const char *now = getenv("STUB");
    return now != NULL && strcmp(now, state) == 0;
}

/* The first camera may be a tracking camera. */
static int lacks_depth(int camera) { return is("no depth") || (is("tracking") && camera <= 0); }

static void *counted(size_t size) {
    alive++;
    return calloc(1, size);
}

static void forget(void *object) {
    alive--;
    free(object);
}

static void fail(void **error, const char *message) {
    Error *made = counted(sizeof *made);
    snprintf(made->message, sizeof made->message, "%s", message);
    if (error != NULL && *error == NULL)
        *error = made;
}

static void *object(int camera) {
    Object *made = counted(sizeof *made);
    made->camera = camera;
    return made;
}

static int camera_of(const void *of) { return ((const Object *)of)->camera; }

__attribute__((destructor)) static void at_the_end(void) {
    if (alive != 0 || running || opened >= 0) {
        fprintf(stderr, "%d objects are left, running %d, open %d\n", alive, running, opened);
        _exit(7);
    }
}

const char *rs2_get_error_message(const void *error) { return ((const Error *)error)->message; }
void rs2_free_error(void *error) { forget(error); }

void *rs2_create_context(int version, void **error) {
    /* Like the library, accept only the same major version, and no minor version newer than its own, here 2.30. */
    if (is("other version") || version / 10000 != 2 || version % 10000 / 100 > 30) {
        fail(error, "API version mismatch");
        return NULL;
    }
    return object(0);
}
void rs2_delete_context(void *context) { forget(context); }

/* Devices. */
static int is_gone(void) { return is("unplugged") && number >= 2; }
void *rs2_query_devices(const void *context, void **error) { (void)context, (void)error; return object(0); }
void rs2_delete_device_list(void *list) { forget(list); }
int rs2_get_device_count(const void *list, void **error) { (void)list, (void)error; return is("no camera") ? 0 : NUM_CAMERAS; }
int rs2_device_list_contains(const void *list, const void *device, void **error) { (void)list, (void)device, (void)error; return !is_gone(); }
void *rs2_create_device(const void *list, int index, void **error) {
    (void)list;
    if (is("no permission")) {
        fail(error, "failed to open usb interface: 0,\n error: RS2_USB_STATUS_ACCESS");
        return NULL;
    }
    return object(index);
}
void rs2_delete_device(void *device) { forget(device); }
int rs2_supports_device_info(const void *device, int info, void **error) { (void)device, (void)error; return info <= 1; }
const char *rs2_get_device_info(const void *device, int info, void **error) {
    (void)error;
    return info == 0 ? "Intel RealSense D435" : serials[camera_of(device)];
}

/* Files; this library has none. In librealsense, each of these calls for a camera throws an exception. */
static void no_playback(void) {
    fputs("a camera plays no file\n", stderr);
    abort();
}
void *rs2_context_add_device(void *context, const char *path, void **error) { (void)context, (void)path; fail(error, "no files here"); return NULL; }
void rs2_playback_device_set_real_time(const void *device, int real_time, void **error) { (void)device, (void)real_time, (void)error; no_playback(); }
void rs2_playback_device_set_playback_speed(const void *device, float speed, void **error) { (void)device, (void)speed, (void)error; no_playback(); }
void rs2_playback_device_pause(const void *device, void **error) { (void)device, (void)error; no_playback(); }
int rs2_playback_device_get_current_status(const void *device, void **error) { (void)device, (void)error; no_playback(); return 0; }

/* Sensors: one for motion, one for depth. */
void *rs2_query_sensors(const void *device, void **error) { (void)error; return object(camera_of(device)); }
void rs2_delete_sensor_list(void *list) { forget(list); }
int rs2_get_sensors_count(const void *list, void **error) { (void)list, (void)error; return 2; }
void *rs2_create_sensor(const void *list, int index, void **error) {
    (void)error;
    return object(index == 0 ? -1 : camera_of(list));
}
void rs2_delete_sensor(void *sensor) { forget(sensor); }
float rs2_get_depth_scale(void *sensor, void **error) { (void)sensor, (void)error; return is("no unit") ? 0.0F : preset == 3 ? 0.0005F : 0.001F; }
int rs2_supports_option(const void *sensor, int option, void **error) { (void)sensor, (void)error; return option == PRESET && !is("no presets"); }
void rs2_get_option_range(const void *sensor, int option, float *min, float *max, float *step, float *usual, void **error) {
    (void)sensor, (void)option, (void)error;
    *min = 0.0F, *max = NUM_PRESETS - 1, *step = 1.0F, *usual = 1.0F;
}
const char *rs2_get_option_value_description(const void *sensor, int option, float value, void **error) {
    (void)sensor, (void)option, (void)error;
    return presets[(int)value];
}
void rs2_set_option(const void *sensor, int option, float value, void **error) { (void)sensor, (void)option, (void)error; preset = (int)value; }

/* Profiles. */
void *rs2_get_stream_profiles(void *sensor, void **error) {
    if (camera_of(sensor) < 0 && !lacks_depth(-1)) {
        fail(error, "the motion module is busy");
        return NULL;
    }
    return object(camera_of(sensor));
}
void rs2_delete_stream_profiles_list(void *list) { forget(list); }
int rs2_get_stream_profiles_count(const void *list, void **error) {
    (void)error;
    return lacks_depth(camera_of(list)) ? 1 : (int)(sizeof profiles / sizeof *profiles);
}
const void *rs2_get_stream_profile(const void *list, int index, void **error) { (void)list, (void)error; return &profiles[index]; }
void rs2_get_stream_profile_data(const void *profile, int *stream, int *format, int *index, int *id, int *rate, void **error) {
    const Profile *of = profile;
    (void)error;
    *stream = of->stream, *format = of->format, *index = 0, *id = (int)(of - profiles), *rate = of->rate;
}
void rs2_get_video_stream_resolution(const void *profile, int *width, int *height, void **error) {
    const Profile *of = profile;
    (void)error;
    *width = of->width, *height = of->height;
}
void rs2_get_video_stream_intrinsics(const void *profile, Intrinsics *made, void **error) {
    const Profile *of = profile;
    (void)error;
    *made = (Intrinsics){ of->width, of->height, of->width / 2.0F, of->height / 2.0F, 421.5F, 421.25F, is("lens") ? 2 : 4, { 0 } };
    if (is("lens"))
        made->coeffs[0] = 0.125F;
}

/* The stream. */
void *rs2_create_frame_queue(int capacity, void **error) { (void)capacity, (void)error; return object(0); }
void rs2_delete_frame_queue(void *queue) { forget(queue); }
void rs2_open(void *sensor, const void *profile, void **error) {
    if (is("busy") || opened >= 0) {
        fail(error, "Device or resource busy");
        return;
    }
    opened = camera_of(sensor);
    mode = profile;
}
void rs2_start_queue(const void *sensor, void *queue, void **error) {
    (void)sensor, (void)queue;
    if (is("no bandwidth")) {
        fail(error, "not enough bandwidth");
        return;
    }
    running = 1;
    number = 0;
}
void rs2_stop(const void *sensor, void **error) {
    (void)sensor;
    if (!running)
        fail(error, "it is not streaming");
    running = 0;
}
void rs2_close(const void *sensor, void **error) {
    (void)sensor;
    if (opened < 0)
        fail(error, "it is not open");
    opened = -1;
}
int rs2_try_wait_for_frame(void *queue, unsigned wait, void **frame, void **error) {
    Frame *made;
    (void)queue;
    usleep(1000 * (wait < 20 ? wait : 20));
    if (is("silent") || is_gone()) {
        if (wait > 20)
            usleep(1000 * (wait - 20));
        return 0;
    }
    if (is("crash") && number == 2) {
        fail(error, "the queue is broken");
        return 0;
    }
    number++;
    made = counted(sizeof *made);
    made->width = mode->width;
    made->height = is("cut") ? mode->height - 1 : mode->height;
    made->stride = 2 * mode->width + PADDING;
    made->data = malloc((size_t)made->stride * (size_t)mode->height);
    for (int row = 0; row < mode->height; row++) {
        uint16_t *pixels = (uint16_t *)(made->data + (size_t)row * (size_t)made->stride);
        for (int column = 0; column < mode->width + PADDING / 2; column++)
            pixels[column] = (uint16_t)(1000 + 3 * column + row);
        if (row == 7)
            pixels[5] = (uint16_t)number;
        if (row == 3)
            pixels[9] = 0, pixels[11] = (uint16_t)opened;
    }
    *frame = made;
    return 1;
}
int rs2_get_frame_width(const void *frame, void **error) { (void)error; return ((const Frame *)frame)->width; }
int rs2_get_frame_height(const void *frame, void **error) { (void)error; return ((const Frame *)frame)->height; }
int rs2_get_frame_stride_in_bytes(const void *frame, void **error) { (void)error; return ((const Frame *)frame)->stride; }
int rs2_get_frame_bits_per_pixel(const void *frame, void **error) { (void)frame, (void)error; return 16; }
int rs2_get_frame_data_size(const void *frame, void **error) {
    const Frame *of = frame;
    (void)error;
    return is("short") ? of->stride : of->stride * of->height;
}
const void *rs2_get_frame_data(const void *frame, void **error) { (void)error; return ((const Frame *)frame)->data; }
double rs2_get_frame_timestamp(const void *frame, void **error) { (void)frame, (void)error; return 1000.0; }
int rs2_get_frame_timestamp_domain(const void *frame, void **error) { (void)frame, (void)error; return 2; }
void rs2_release_frame(void *frame) {
    free(((Frame *)frame)->data);
    forget(frame);
}
