//! Requests that a client may send.

use std::time::Duration;

use geometry::rigid::RigidTransform;
use stages::segment::MAX_PARTS;

/// A client's request.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Capture a frame from now on, and inspect it.
    Trigger {
        /// The parts that should hang there, then none; all none if nothing is expected.
        expected: ExpectedNumbers,
        /// What the encoder of the line shows; `None` if it was not sent.
        count: Option<u32>,
        /// How long before the request the count was read.
        count_age: Duration,
        /// The order whose parts should hang there, instead of their numbers.
        order: AskedOrder,
    },
    /// Send the camera's state, and the last verdict without its numbers.
    Status,
    /// Send the last inspection again.
    Last,
    /// Send a point of the part's spray path, moved by the pose of an inspection.
    Path {
        /// The point's number from 1, or 0 for the number of points.
        point: u32,
        /// The inspection's sequence number; `None` for that of the client's own last trigger.
        sequence: Option<u32>,
    },
    /// Send a part of the frame of an inspection, as a trigger sends the first one.
    Part {
        /// The part's number in the frame from 1, or 0 for the number of parts.
        number: u32,
        /// The sequence number of any part of the frame; `None` for that of the client's own last trigger.
        sequence: Option<u32>,
    },
    /// Say where the robot, which is at rest, should go next so that the part stands where it should.
    Servo(ServoRequest),
}

/// What a robot at rest says when it asks for its next move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoRequest {
    /// The number of the part; 0 for none.
    pub part: u32,
    /// True if this begins a new run, whatever went before.
    pub is_start: bool,
    /// Pose of the flange in the base frame.
    pub robot_from_flange: RigidTransform,
}

/// A part that is expected in a frame, by numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExpectedNumber {
    /// The number of the part; 0 for none.
    pub part: u32,
    /// The number of its place in the order of the rack's file, from 1; 0 for any.
    pub place: u32,
}

impl ExpectedNumber {
    /// True if it says anything: messages of fixed length end with zeros.
    pub fn is_given(self) -> bool {
        self.part > 0 || self.place > 0
    }
}

/// Longest time before a trigger at which its count may have been read, milliseconds.
const MAX_COUNT_AGE_MS: f64 = 10_000.0;

/// The time before a trigger at which its count was read; `None` if it is none, or too long.
pub fn count_age(milliseconds: f64) -> Option<Duration> {
    let is_one = (0.0..=MAX_COUNT_AGE_MS).contains(&milliseconds);
    is_one.then(|| Duration::from_secs_f64(milliseconds / 1000.0))
}

/// The order that a trigger names; its texts are empty if they were not sent.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AskedOrder {
    /// The production order.
    pub order: String,
    /// The serial number.
    pub serial: String,
}

impl AskedOrder {
    /// Takes the texts without the blanks around them; `None` if one has control characters.
    pub fn new(order: &str, serial: &str) -> Option<Self> {
        let is_plain = |text: &str| !text.chars().any(char::is_control);
        let [order, serial] = [order, serial].map(|text| text.trim().to_owned());
        (is_plain(&order) && is_plain(&serial)).then_some(Self { order, serial })
    }

    /// True if it says anything.
    pub fn is_given(&self) -> bool {
        !self.order.is_empty() || !self.serial.is_empty()
    }
}

/// The parts that are expected in a frame.
pub type ExpectedNumbers = [ExpectedNumber; MAX_PARTS];

impl Request {
    /// A trigger that expects nothing.
    pub const TRIGGER: Self = Self::Trigger {
        expected: [ExpectedNumber { part: 0, place: 0 }; MAX_PARTS],
        count: None,
        count_age: Duration::ZERO,
        order: AskedOrder {
            order: String::new(),
            serial: String::new(),
        },
    };

    /// The word in text protocols, and the code in binary frames.
    pub(super) fn name(&self) -> (&'static str, u16) {
        match self {
            Self::Trigger { .. } => ("TRIGGER", 1),
            Self::Status => ("STATUS", 2),
            Self::Last => ("LAST", 3),
            Self::Path { .. } => ("PATH", 4),
            Self::Part { .. } => ("PART", 5),
            Self::Servo(_) => ("SERVO", 6),
        }
    }

    /// Finds a request whose name, in a text or in a frame, fulfils `is_it`; its numbers are 0.
    pub(super) fn find(is_it: impl Fn((&str, u16)) -> bool) -> Option<Self> {
        let (path, part) = (Self::path(0, 0), Self::part(0, 0));
        let servo = Self::Servo(ServoRequest {
            part: 0,
            is_start: false,
            robot_from_flange: RigidTransform::identity(),
        });
        let mut all = [Self::TRIGGER, Self::Status, Self::Last, path, part, servo].into_iter();
        all.find(|request| is_it(request.name()))
    }

    /// A request for a point of a path; the sequence number 0 stands for the client's own last trigger.
    pub fn path(point: u32, sequence: u32) -> Self {
        Self::Path {
            point,
            sequence: (sequence > 0).then_some(sequence),
        }
    }

    /// A request for a part of a frame; the sequence number 0 stands for the client's own last trigger.
    pub fn part(number: u32, sequence: u32) -> Self {
        Self::Part {
            number,
            sequence: (sequence > 0).then_some(sequence),
        }
    }

    /// A trigger that expects these parts; `None` if they are more than a frame can show.
    pub fn expecting(parts: impl IntoIterator<Item = ExpectedNumber>) -> Option<Self> {
        let mut expected = ExpectedNumbers::default();
        for (index, part) in parts.into_iter().enumerate() {
            *expected.get_mut(index)? = part;
        }
        let (count, order) = (None, AskedOrder::default());
        Some(Self::Trigger {
            expected,
            count,
            count_age: Duration::ZERO,
            order,
        })
    }

    /// A trigger at this count of the line's encoder; other requests stay as they are.
    #[must_use]
    pub fn at_count(mut self, new: Option<u32>) -> Self {
        if let Self::Trigger { count, .. } = &mut self {
            *count = new;
        }
        self
    }

    /// A trigger whose count was read this long before; other requests stay as they are.
    #[must_use]
    pub fn read_before(mut self, new: Duration) -> Self {
        if let Self::Trigger { count_age, .. } = &mut self {
            *count_age = new;
        }
        self
    }

    /// A trigger for the parts of this order; `None` if it names parts as well. Other requests stay as they are.
    pub fn of_order(mut self, new: AskedOrder) -> Option<Self> {
        if let Self::Trigger {
            expected, order, ..
        } = &mut self
        {
            if new.is_given() && expected.iter().any(|one| one.is_given()) {
                return None;
            }
            *order = new;
        }
        Some(self)
    }

    /// The request with these numbers; `None` if it does not take as many.
    pub(super) fn numbered(&self, numbers: &[u32]) -> Option<Self> {
        match (self, numbers) {
            (Self::Trigger { .. }, _) => {
                let parts = numbers.iter();
                Self::expecting(parts.map(|&part| ExpectedNumber { part, place: 0 }))
            }
            // Its pose is read by the protocol, in the convention of the port.
            (Self::Servo(_), _) => None,
            (_, []) => Some(self.clone()),
            (Self::Path { .. }, [point]) => Some(Self::path(*point, 0)),
            (Self::Path { .. }, [point, sequence]) => Some(Self::path(*point, *sequence)),
            (Self::Part { .. }, [number]) => Some(Self::part(*number, 0)),
            (Self::Part { .. }, [number, sequence]) => Some(Self::part(*number, *sequence)),
            _ => None,
        }
    }

    /// Its numbers, without those of places and without zeros at their end.
    pub(super) fn numbers(&self) -> Vec<u32> {
        let mut numbers = match *self {
            Self::Path {
                point: number,
                sequence,
            }
            | Self::Part { number, sequence } => vec![number, sequence.unwrap_or(0)],
            Self::Trigger { ref expected, .. } => expected.iter().map(|one| one.part).collect(),
            Self::Servo(servo) => vec![servo.part],
            Self::Status | Self::Last => Vec::new(),
        };
        while numbers.pop_if(|number| *number == 0).is_some() {}
        numbers
    }
}
