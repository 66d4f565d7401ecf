/* Stubs of the libfreenect functions that Partsight calls, which behave like the real library with a camera plugged in.
   STUB names the fault of the camera; every call is logged in the file that STUB_LOG names. */

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>

typedef struct {
    uint32_t reserved;
    int32_t resolution, format, bytes;
    int16_t width, height;
    int8_t bits, padding, rate, valid;
} mode;

struct attributes {
    struct attributes *next;
    char *serial;
};

typedef void (*on_depth)(void *, void *, uint32_t);
typedef void (*on_log)(void *, int, const char *);

static int the_context, the_device, is_started, calls;
static on_depth depth_callback;
static on_log log_callback;
static uint16_t *frame;

static int is(const char *state) {
    const char *now = getenv("STUB");
    return now && !strcmp(now, state);
}

static void called(const char *name, int value) {
    FILE *log = fopen(getenv("STUB_LOG"), "a");
    fprintf(log, "%s %d\n", name, value);
    fclose(log);
}

static int refuse(const char *words) {
    log_callback(&the_context, 1, words);
    return -1;
}

int freenect_init(void **context, void *usb) {
    called("init", usb != 0);
    if (is("no usb"))
        return -99;
    *context = &the_context;
    return 0;
}

int freenect_shutdown(void *context) {
    called("shutdown", context == &the_context);
    return 0;
}

void freenect_set_log_level(void *context, int level) { (void)context, (void)level; }
void freenect_set_log_callback(void *context, on_log callback) { (void)context, log_callback = callback; }
void freenect_select_subdevices(void *context, int flags) { (void)context, called("select", flags); }

int freenect_num_devices(void *context) {
    (void)context;
    return is("no device") ? 0 : 2;
}

int freenect_list_device_attributes(void *context, struct attributes **list) {
    static const char *serials[] = {"A00362", "B00417"};
    int num = is("no permission") ? 0 : 2;
    (void)context;
    *list = 0;
    for (int k = num - 1; k >= 0; k--) {
        struct attributes *one = malloc(sizeof *one);
        one->next = *list;
        one->serial = strdup(serials[k]);
        *list = one;
    }
    return num;
}

void freenect_free_device_attributes(struct attributes *list) {
    while (list) {
        struct attributes *next = list->next;
        free(list->serial);
        free(list);
        list = next;
    }
}

static int open_one(void **device, int index) {
    if (is("no permission"))
        return refuse("Could not open camera: -3\n");
    if (is("busy"))
        return refuse("Failed to claim camera interface: LIBUSB_ERROR_BUSY\n");
    called("open", index);
    *device = &the_device;
    /* The real library keeps a device that fails here in its list, and closes it in its shutdown. */
    return is("half open") ? refuse("freenect_camera_init(): Failed to fetch const shift for device\n") : 0;
}

int freenect_open_device(void *context, void **device, int index) { (void)context; return open_one(device, index); }

int freenect_open_device_by_camera_serial(void *context, void **device, const char *serial) {
    (void)context;
    return open_one(device, strcmp(serial, "A00362") ? 1 : 0);
}

int freenect_close_device(void *device) {
    called("close", device == &the_device);
    return 0;
}

static const mode modes[] = {
    {0x100, 1, 0, 614400, 640, 480, 11, 5, 30, 1},
    {0x102, 1, 2, 422400, 640, 480, 11, 0, 30, 1},
    {0x104, 1, 4, 614400, 640, 480, 16, 0, 30, 1},
    {0x105, 1, 5, 614400, 640, 480, 16, 0, 30, 1},
};

int freenect_get_depth_mode_count(void) { return is("no mode") ? 0 : 4; }
mode freenect_get_depth_mode(int index) { return modes[index]; }

int freenect_set_depth_mode(void *device, const mode wanted) {
    (void)device;
    called("mode", wanted.reserved == modes[3].reserved ? wanted.format : -1);
    return 0;
}

void freenect_set_depth_callback(void *device, on_depth callback) { (void)device, depth_callback = callback; }

#ifndef OLD
int freenect_start_depth(void *device) {
    if (is("no bandwidth"))
        return refuse("Failed to submit isochronous transfer: -1\n");
    called("start", device == &the_device);
    frame = malloc(640 * 480 * sizeof *frame);
    is_started = 1;
    return 0;
}
#endif

int freenect_stop_depth(void *device) {
    called("stop", device == &the_device);
    if (!is_started)
        return -1;
    is_started = 0;
    free(frame);
    return 0;
}

static void give(uint16_t depth) {
    for (int k = 0; k < 640 * 480; k++)
        frame[k] = k % 640 < 320 ? depth : 10000;
    depth_callback(&the_device, frame, 2000000u * depth);
}

int freenect_process_events_timeout(void *context, struct timeval *wait) {
    (void)context;
    if (wait->tv_sec != 0 || wait->tv_usec < 0 || wait->tv_usec > 999999)
        return -2;
    calls++;
    if (is("silent"))
        return 0;
    if (is("signals") && calls % 2)
        return -10;
    if (is("unplugged") && calls > 2) {
        freenect_stop_depth(&the_device);
        return refuse("USB camera marked dead, stopping streams\n");
    }
    /* Two frames at once: only the newer one is of use. */
    give(1000 + 2 * calls);
    give(1001 + 2 * calls);
    return 0;
}

void freenect_camera_to_world(void *device, int column, int row, int depth, double *x, double *y) {
    double factor = 2 * 0.1039 * depth / 121.2;
    (void)device;
    *x = (column - 320) * factor;
    *y = (row - 240) * factor;
}

/* Partsight must not call these. */
int freenect_set_tilt_degs(void *device, double angle) { (void)device, (void)angle; called("tilt", 1); return 0; }
int freenect_set_led(void *device, int led) { (void)device, (void)led; called("led", 1); return 0; }
