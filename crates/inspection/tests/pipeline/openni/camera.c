/* A driver for OpenNI 2 that plays one camera, in the state that STUB names. Like every OpenNI driver, it mirrors the picture
 * itself while the mirroring of its stream is on.
 *
 * A pixel holds 1000 + 10 column + row millimetres, except column 5, row 7: 500 + the number of the frame, and column 9, row 3:
 * no reading. */
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { OK = 0, FAILED = 1, NOT_IMPLEMENTED = 2 };
enum { DEPTH = 3 };
enum { MILLIMETRES = 100, TENTHS = 101, SHIFTS = 102 };
enum { CROPPING = 0, H_FOV = 1, V_FOV = 2, VIDEO_MODE = 3, MAX_VALUE = 4, STRIDE = 6, MIRRORING = 7 };

typedef struct { int format, width, height, fps; } Mode;
typedef struct { int type, num_modes; Mode *modes; } Sensor;
typedef struct { char uri[256], vendor[256], name[256]; uint16_t usb_vendor, usb_product; } Info;
typedef struct { int enabled, x, y, width, height; } Cropping;
typedef struct {
    int size; void *data; int sensor; uint64_t time; int number, width, height;
    Mode mode; int cropped, x, y, stride;
} Frame;
typedef struct {
    void *self; int (*size)(void *); Frame *(*acquire)(void *); void (*keep)(void *, Frame *); void (*release)(void *, Frame *);
} Services;

static const Info camera = { "stub@1", "Partsight", "Stub camera", 0x1d27, 0x0601 };
static Mode usual_modes[] = {
    { MILLIMETRES, 16, 12, 60 }, { MILLIMETRES, 64, 48, 30 }, { SHIFTS, 64, 48, 60 }, { TENTHS, 64, 48, 30 }, { MILLIMETRES, 128, 96, 7 },
};
static Mode fine_modes[] = { { TENTHS, 64, 48, 30 } };
static Mode shift_modes[] = { { SHIFTS, 64, 48, 30 } };

static void (*on_lost)(const Info *, void *);
static void *cookie;
static void (*on_frame)(void *, Frame *, void *);
static void *frame_cookie;
static void (*on_change)(void *, int, const void *, int, void *);
static void *change_cookie;
static Services *services;
static Mode mode;
static Cropping cropping;
static int mirrored, number;
static volatile int running;
static pthread_t thread;

static int is(const char *state) {
    const char *now = getenv("STUB");
    return now != NULL && strcmp(now, state) == 0;
}

static int pixel(int column, int row) {
    int mm = column == 5 && row == 7 ? 500 + number : column == 9 && row == 3 ? 0 : 1000 + 10 * column + row;
    return mode.format == TENTHS ? 10 * mm : mm;
}

static void send_frame(void) {
    Frame *frame = services->acquire(services->self);
    uint16_t *data = frame->data;
    number++;
    for (int row = 0; row < mode.height; row++)
        for (int column = 0; column < mode.width; column++)
            *data++ = (uint16_t)pixel(mirrored ? mode.width - 1 - column : column, row);
    frame->size = 2 * mode.width * mode.height;
    frame->sensor = DEPTH;
    frame->time = (uint64_t)number * 33333;
    frame->number = number;
    frame->width = mode.width;
    frame->height = mode.height;
    frame->mode = mode;
    frame->cropped = is("cropped");
    frame->x = frame->y = 0;
    frame->stride = 2 * mode.width;
    on_frame(services, frame, frame_cookie);
    services->release(services->self, frame);
}

static void *work(void *unused) {
    (void)unused;
    while (running) {
        usleep(10000);
        if (is("unplugged") && number == 2) {
            number++;
            on_lost(&camera, cookie);
        }
        if (is("turned") && number == 2) {
            mirrored = !mirrored;
            on_change(services, MIRRORING, &mirrored, sizeof mirrored, change_cookie);
        }
        if (!is("silent") && !(is("unplugged") && number > 2))
            send_frame();
    }
    return NULL;
}

/* The driver. */
void oniDriverCreate(void *given) { (void)given; }
void oniDriverDestroy(void) {}
int oniDriverInitialize(void (*found)(const Info *, void *), void (*lost)(const Info *, void *), void *state, void *its) {
    (void)state;
    on_lost = lost;
    cookie = its;
    if (!is("no camera"))
        found(&camera, cookie);
    return OK;
}
int oniDriverTryDevice(const char *uri) { (void)uri; return FAILED; }
void *oniDriverEnableFrameSync(void **streams, int num) { (void)streams, (void)num; return NULL; }
void oniDriverDisableFrameSync(void *group) { (void)group; }

/* The camera. */
void *oniDriverDeviceOpen(const char *uri, const char *how) {
    (void)uri, (void)how;
    number = 0;
    mode = is("fine") ? fine_modes[0] : is("shifts") ? shift_modes[0] : usual_modes[0];
    mirrored = !is("upright");
    cropping = (Cropping){ 0, 0, 0, 0, 0 };
    return is("busy") ? NULL : (void *)&camera;
}
void oniDriverDeviceClose(void *device) { (void)device; }
int oniDriverDeviceGetSensorInfoList(void *device, Sensor **sensors, int *num) {
    static Sensor depth = { DEPTH, 5, usual_modes };
    (void)device;
    if (is("fine") || is("shifts"))
        depth = (Sensor){ DEPTH, 1, is("fine") ? fine_modes : shift_modes };
    *sensors = &depth;
    *num = 1;
    return OK;
}
void *oniDriverDeviceCreateStream(void *device, int type) { (void)device; return type == DEPTH ? (void *)&mode : NULL; }
void oniDriverDeviceDestroyStream(void *device, void *stream) { (void)device, (void)stream; }
int oniDriverDeviceSetProperty(void *device, int id, const void *data, int size) { (void)device, (void)id, (void)data, (void)size; return NOT_IMPLEMENTED; }
int oniDriverDeviceGetProperty(void *device, int id, void *data, int *size) { (void)device, (void)id, (void)data, (void)size; return NOT_IMPLEMENTED; }
int oniDriverDeviceIsPropertySupported(void *device, int id) { (void)device, (void)id; return 0; }
void oniDriverDeviceSetPropertyChangedCallback(void *device, void *handler, void *its) { (void)device, (void)handler, (void)its; }
void oniDriverDeviceNotifyAllProperties(void *device) { (void)device; }
int oniDriverDeviceInvoke(void *device, int id, void *data, int size) { (void)device, (void)id, (void)data, (void)size; return NOT_IMPLEMENTED; }
int oniDriverDeviceIsCommandSupported(void *device, int id) { (void)device, (void)id; return 0; }
int oniDriverDeviceTryManualTrigger(void *device) { (void)device; return OK; }
int oniDriverDeviceIsImageRegistrationModeSupported(void *device, int how) { (void)device; return how == 0; }

/* Its stream of depth. */
void oniDriverStreamSetServices(void *stream, Services *given) { (void)stream; services = given; }
static int known(int id, const void **value, int *size) {
    static float h_fov, v_fov;
    static int max, stride;
    h_fov = is("no view") ? 0.0F : 1.0F;
    v_fov = is("no view") ? 0.0F : 0.8F;
    max = mode.format == TENTHS ? 65535 : 10000;
    stride = 2 * mode.width;
    switch (id) {
    case CROPPING: *value = &cropping; *size = sizeof cropping; return 1;
    case H_FOV: *value = &h_fov; *size = sizeof h_fov; return 1;
    case V_FOV: *value = &v_fov; *size = sizeof v_fov; return 1;
    case VIDEO_MODE: *value = &mode; *size = sizeof mode; return 1;
    case MAX_VALUE: *value = &max; *size = sizeof max; return 1;
    case STRIDE: *value = &stride; *size = sizeof stride; return 1;
    case MIRRORING: *value = &mirrored; *size = sizeof mirrored; return !is("untold");
    default: return 0;
    }
}
int oniDriverStreamGetProperty(void *stream, int id, void *data, int *size) {
    const void *value;
    int needed;
    (void)stream;
    if (!known(id, &value, &needed) || *size < needed)
        return NOT_IMPLEMENTED;
    memcpy(data, value, (size_t)needed);
    *size = needed;
    return OK;
}
int oniDriverStreamSetProperty(void *stream, int id, const void *data, int size) {
    (void)stream;
    if (id == MIRRORING && size == sizeof mirrored && !is("stuck") && !is("untold"))
        memcpy(&mirrored, data, sizeof mirrored);
    else if (id == VIDEO_MODE && size == sizeof mode)
        memcpy(&mode, data, sizeof mode);
    else if (id == CROPPING && size == sizeof cropping)
        memcpy(&cropping, data, sizeof cropping);
    else
        return NOT_IMPLEMENTED;
    return OK;
}
int oniDriverStreamIsPropertySupported(void *stream, int id) {
    const void *value;
    int size;
    (void)stream;
    return known(id, &value, &size);
}
void oniDriverStreamSetPropertyChangedCallback(void *stream, void (*handler)(void *, int, const void *, int, void *), void *its) {
    (void)stream;
    on_change = handler;
    change_cookie = its;
}
void oniDriverStreamNotifyAllProperties(void *stream) { (void)stream; }
int oniDriverStreamInvoke(void *stream, int id, void *data, int size) { (void)stream, (void)id, (void)data, (void)size; return NOT_IMPLEMENTED; }
int oniDriverStreamIsCommandSupported(void *stream, int id) { (void)stream, (void)id; return 0; }
int oniDriverStreamStart(void *stream) {
    (void)stream;
    running = 1;
    return is("no bandwidth") || pthread_create(&thread, NULL, work, NULL) != 0 ? FAILED : OK;
}
void oniDriverStreamStop(void *stream) {
    (void)stream;
    if (running && !is("no bandwidth"))
        pthread_join((running = 0, thread), NULL);
}
int oniDriverStreamGetRequiredFrameSize(void *stream) { (void)stream; return 2 * mode.width * mode.height; }
void oniDriverStreamSetNewFrameCallback(void *stream, void (*handler)(void *, Frame *, void *), void *its) {
    (void)stream;
    on_frame = handler;
    frame_cookie = its;
}
int oniDriverStreamConvertDepthToColorCoordinates(void *depth, void *colour, int column, int row, uint16_t z, int *x, int *y) {
    (void)depth, (void)colour, (void)column, (void)row, (void)z, (void)x, (void)y;
    return NOT_IMPLEMENTED;
}
