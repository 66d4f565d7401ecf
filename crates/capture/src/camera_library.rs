//! The libraries of cameras, one table each: names, files, and what to do if a camera fails.

/// The library of one kind of camera.
#[derive(Debug, PartialEq, Eq)]
pub struct CameraLibrary {
    /// Name of the library.
    pub name: &'static str,
    /// One of its cameras, without an article.
    pub(crate) camera: &'static str,
    /// Its cameras, in the plural.
    pub(crate) cameras: &'static str,
    /// How a camera is there, after "no Kinect".
    pub(crate) presence: &'static str,
    /// The name with the versions that are supported.
    pub(crate) versions: &'static str,
    /// How to install it on this system: a command, or a few words.
    pub(crate) install: &'static str,
    /// Environment variable with the library's file or folder; the source's own setting takes precedence.
    pub(crate) variable: &'static str,
    /// File names to try, the best-tested version first.
    pub(crate) file_names: &'static [&'static str],
    /// What to do if its cameras fail.
    pub(crate) advice: CameraAdvice,
}

/// What to do about an error whose cause depends on the kind of camera; `{install}` stands for [`CameraLibrary::install`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CameraAdvice {
    pub(crate) library_not_started: &'static str,
    pub(crate) no_device: &'static str,
    /// The requested device is not there, but others are.
    pub(crate) other_devices: &'static str,
    pub(crate) not_opened: &'static str,
    pub(crate) not_started: &'static str,
    pub(crate) disconnected: &'static str,
    pub(crate) no_frames: &'static str,
}

/// libfreenect, for Kinects.
pub static FREENECT: CameraLibrary = CameraLibrary {
    name: "libfreenect",
    camera: "Kinect",
    cameras: "Kinects",
    presence: "is plugged in",
    versions: "libfreenect 0.5",
    install: if cfg!(target_os = "macos") {
        "brew install libfreenect"
    } else if cfg!(windows) {
        "put freenect.dll 0.5 and libusb-1.0.dll beside the program"
    } else {
        "sudo apt-get install libfreenect0.5"
    },
    variable: "PARTSIGHT_FREENECT",
    file_names: if cfg!(target_os = "macos") {
        &[
            "libfreenect.0.5.dylib",
            "libfreenect.0.dylib",
            "libfreenect.dylib",
            // Homebrew's folder on Apple silicon is not among those that the system searches.
            "/opt/homebrew/lib/libfreenect.dylib",
        ]
    } else if cfg!(windows) {
        &["freenect.dll", "libfreenect.dll"]
    } else {
        &["libfreenect.so.0.5", "libfreenect.so.0", "libfreenect.so"]
    },
    advice: CameraAdvice {
        library_not_started: "Check that this computer has USB and that the user may use it, then start again",
        no_device: "Plug the Kinect in, and its own power supply too: without it only its motor is seen",
        other_devices: "Plug that one in, or choose the source without a serial number to take whichever is there",
        not_opened: "Unplug the Kinect and plug it in again",
        not_started: "Plug the Kinect into another USB socket, with no other camera on the same hub",
        disconnected: "Check the Kinect's cable and its power supply",
        no_frames: "Check the Kinect's power supply, and plug it into a USB socket of the computer itself, not of a hub",
    },
};

/// aravis, for GenICam cameras.
pub static ARAVIS: CameraLibrary = CameraLibrary {
    name: "aravis",
    camera: "GenICam camera",
    cameras: "GenICam cameras",
    presence: "answers on any network interface or USB port",
    versions: "aravis 0.8.26 or a newer 0.8",
    install: if cfg!(target_os = "macos") {
        "brew install aravis"
    } else if cfg!(windows) {
        "on a computer with Linux or macOS"
    } else {
        "sudo apt-get install libaravis-0.8-0"
    },
    variable: "PARTSIGHT_ARAVIS",
    file_names: if cfg!(target_os = "macos") {
        &[
            "libaravis-0.8.0.dylib",
            "libaravis-0.8.dylib",
            // Homebrew's folder on Apple silicon is not among those that the system searches.
            "/opt/homebrew/lib/libaravis-0.8.0.dylib",
        ]
    } else if cfg!(windows) {
        &["libaravis-0.8-0.dll", "aravis-0.8-0.dll"]
    } else {
        &["libaravis-0.8.so.0", "libaravis-0.8.so"]
    },
    advice: CameraAdvice {
        library_not_started: "Install a newer aravis 0.8 ({install})",
        no_device: "Check the camera's power and cable, and that a GigE camera has an address in the network of this computer",
        other_devices: "Connect that one, or list the cameras and choose another: partsight capture --list",
        not_opened: "Close other programs that use the camera; for a USB camera, install the udev rule that lets your user open it",
        not_started: "Switch the camera off and on again, and set a smaller picture if its pictures are very large",
        disconnected: "Check the camera's cable and its power supply",
        no_frames: "Set TriggerMode to Off with the camera's own program, and let the firewall pass UDP from the camera",
    },
};

/// libOpenNI2, for the cameras and recorded files of OpenNI 2.
pub static OPENNI: CameraLibrary = CameraLibrary {
    name: "libOpenNI2",
    camera: "OpenNI camera",
    cameras: "OpenNI cameras",
    presence: "is plugged in",
    versions: "libOpenNI2 2.2",
    install: if cfg!(target_os = "macos") {
        "brew install openni2"
    } else if cfg!(windows) {
        "put OpenNI2.dll with its folder OpenNI2 beside the program"
    } else {
        "sudo apt-get install libopenni2-0"
    },
    variable: "PARTSIGHT_OPENNI",
    // The library finds its drivers in the folder `OpenNI2/Drivers` beside it.
    file_names: if cfg!(target_os = "macos") {
        &["libOpenNI2.dylib", "/opt/homebrew/lib/ni2/libOpenNI2.dylib"]
    } else if cfg!(windows) {
        &["OpenNI2.dll"]
    } else {
        &["libOpenNI2.so.0", "libOpenNI2.so"]
    },
    advice: CameraAdvice {
        library_not_started: "Put the folder OpenNI2/Drivers with the camera's driver beside the library",
        no_device: "Plug the camera in; if it is plugged in, put its maker's driver into OpenNI2/Drivers beside the library",
        other_devices: "See partsight capture --list: the name changes when the camera is plugged in again; openni alone takes the first one",
        not_opened: "Close other programs that use the camera; if there are none, install the udev rule that permits it ({install}) and plug the camera in again",
        not_started: "Plug the camera into another USB socket, with no other camera on the same hub",
        disconnected: "Check the camera's cable",
        no_frames: "Plug the camera into a USB socket of the computer itself, not of a hub",
    },
};

/// File names on Linux. If only the runtime packages are installed, the name contains the minor version; the newest is
/// preferred.
macro_rules! with_minor_versions {
    ($($minor:literal)*) => {
        &["librealsense2.so", $(concat!("librealsense2.so.2.", $minor)),*]
    };
}

/// librealsense 2, for RealSense cameras and the files that it records.
pub static REALSENSE: CameraLibrary = CameraLibrary {
    name: "librealsense2",
    camera: "RealSense camera",
    cameras: "RealSense cameras",
    presence: "is plugged in",
    versions: "librealsense 2.30 or a newer 2",
    install: if cfg!(target_os = "macos") {
        "brew install librealsense"
    } else if cfg!(windows) {
        "put realsense2.dll beside the program"
    } else {
        "librealsense2 from https://github.com/realsenseai/librealsense/blob/master/doc/distribution_linux.md"
    },
    variable: "PARTSIGHT_REALSENSE",
    file_names: if cfg!(target_os = "macos") {
        // Homebrew's folder on Apple silicon is not among those that the system searches.
        &[
            "librealsense2.dylib",
            "/opt/homebrew/lib/librealsense2.dylib",
        ]
    } else if cfg!(windows) {
        &["realsense2.dll"]
    } else {
        with_minor_versions!(
            79 78 77 76 75 74 73 72 71 70 69 68 67 66 65 64 63 62 61 60 59 58 57 56 55
            54 53 52 51 50 49 48 47 46 45 44 43 42 41 40 39 38 37 36 35 34 33 32 31 30
        )
    },
    advice: CameraAdvice {
        library_not_started: "Install a newer librealsense 2 ({install})",
        no_device: "Plug the camera in, with a cable for USB 3; if it is plugged in, install the udev rule that lets your user open it",
        other_devices: "Plug that one in, or list the cameras and choose another: partsight capture --list",
        not_opened: "Close other programs that use the camera; if there are none, install the udev rule that lets your user open it, and plug it in again",
        not_started: "Close other programs that use the camera; if there are none, plug it into another USB 3 socket, with no other camera on the same hub",
        disconnected: "Check the camera's cable",
        no_frames: "Plug the camera into a USB 3 socket of the computer itself, not of a hub",
    },
};
