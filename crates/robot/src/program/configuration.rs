//! The configuration of an arm at a point in each controller's notation, from the joints found by the check of its
//! reach.
//!
//! | format | words | shoulder | elbow | wrist | turns | source |
//! | --- | --- | --- | --- | --- | --- | --- |
//! | KUKA KRL | `S`, `T` | `S` bit 0: wrist behind axis 1 | bit 1: elbow up | bit 2: A5 < 0 | `T` bits 0 to 5: axis 1 to 6 < 0 | KUKA, *System Software, Operating and Programming Instructions for System Integrators*, "Status and Turn" |
//! | FANUC LS | `CONFIG` | T, B | U, D | N: J5 < 0, F | of J4, J5, J6: 0 within ±180°, ±1 up to 540° | FANUC, *R-30iB Operator's Manual (Basic Operation)*, "Position data", configuration |
//! | ABB RAPID | confdata | cfx 4: wrist behind axis 1 | cfx 2: wrist behind the lower arm | cfx 1: axis 5 < 0 | cf1, cf4, cf6: quarter turns | ABB, *RAPID Instructions, Functions and Data types*, "confdata" |
//! | Yaskawa JBI | `RCONF` | third: 1 behind | second: 1 lower arm | first: 1 no flip, B < 0 | R, T, S: 1 from ±180° on | Yaskawa, *DX100 Options: Instructions for Data Transmission*, "RCONF" |
//!
//! Front and back are the sides of joint 1 on which the centre of the wrist may lie; the elbow is up if the forearm
//! bends forward from the upper arm. Both follow from the arm's lengths, so they change exactly where the arm is
//! singular. Joint 3 of FANUC arms is counted against the upper arm here and against the horizontal there; CONFIG does
//! not count its turns, so the coupling does not matter.
//!
//! Universal Robots' and Doosan's arms are not among those that can be checked, and how a controller counts the joints
//! of an arm from a file is unknown: without a maker, or with another maker's format, there is no configuration.
//!
//! Uncertain: `$SCR_GRP[1].$TURN_AXIS` sets which joints CONFIG counts, here the usual 4, 5, 6; it matters where J4 is
//! beyond ±180°. The manuals of FANUC and Yaskawa draw the elbow with the wrist in front only. Yaskawa's older manuals
//! (NX100) define flip by R instead; jobs recorded on a YRC1000 use B, and the elbow behind joint 1 as here.

use super::ProgramFormat;
use crate::arm::{Arm, Joints};

/// Joints are rounded to this many steps per degree before they are compared, as fine as poses are written.
const STEPS: f64 = 1e4;
/// RCONF cannot express turns beyond this, degrees.
const MOST_JBI: f64 = 360.0;

/// Returns the arm's configuration with these joints; `None` if it is not certain.
pub(super) fn configuration(format: ProgramFormat, arm: &Arm, joints: &Joints) -> Option<String> {
    if arm.maker != Some(format.convention()) {
        return None;
    }
    let [is_ahead, is_elbow_up, _] = arm.configuration(joints);
    let degrees = joints.map(|angle| (angle.to_degrees() * STEPS).round() / STEPS);
    let main = [is_ahead, is_elbow_up];
    match format {
        ProgramFormat::Krl => Some(krl(main, &degrees)),
        ProgramFormat::Ls => Some(ls(main, &degrees)),
        ProgramFormat::Rapid => Some(rapid(main, &degrees)),
        ProgramFormat::Jbi => jbi(main, &degrees),
        ProgramFormat::UrScript | ProgramFormat::Drl => None,
    }
}

fn krl([is_ahead, is_elbow_up]: [bool; 2], degrees: &[f64; 6]) -> String {
    let bits = |all: &[bool]| -> u8 {
        let all = all.iter().enumerate();
        all.map(|(i, is_set)| u8::from(*is_set) << i).sum()
    };
    let status = bits(&[!is_ahead, is_elbow_up, degrees[4] < 0.0]);
    let turn = bits(&degrees.map(|angle| angle < 0.0));
    format!("S {status},T {turn}")
}

fn ls([is_ahead, is_elbow_up]: [bool; 2], degrees: &[f64; 6]) -> String {
    let [_, _, _, j4, j5, j6] = *degrees;
    let flip = if j5 < 0.0 { 'N' } else { 'F' };
    let elbow = if is_elbow_up { 'U' } else { 'D' };
    let side = if is_ahead { 'T' } else { 'B' };
    let turn = |angle: f64| ((angle.abs() + 180.0) / 360.0).floor() as i32 * angle.signum() as i32;
    let turns = [j4, j5, j6].map(turn).map(|turn| turn.to_string());
    format!("{flip} {elbow} {side}, {}", turns.join(", "))
}

fn rapid([is_ahead, is_elbow_up]: [bool; 2], degrees: &[f64; 6]) -> String {
    let [a1, _, _, a4, a5, a6] = *degrees;
    let [cf1, cf4, cf6] = [a1, a4, a6].map(|angle| (angle / 90.0).floor() as i32);
    let cfx = 4 * u8::from(!is_ahead) + 2 * u8::from(!is_elbow_up) + u8::from(a5 < 0.0);
    format!("[{cf1},{cf4},{cf6},{cfx}]")
}

fn jbi([is_ahead, is_elbow_up]: [bool; 2], degrees: &[f64; 6]) -> Option<String> {
    let [s, _, _, r, b, t] = *degrees;
    let turning = [r, t, s];
    if turning.iter().any(|angle| angle.abs() > MOST_JBI) {
        return None;
    }
    let main = [b < 0.0, !is_elbow_up, !is_ahead];
    let turns = turning.map(|angle| angle.abs() >= 180.0);
    let all = main.into_iter().chain(turns);
    let all: Vec<String> = all.map(|is_set| u8::from(is_set).to_string()).collect();
    Some(all.join(","))
}
