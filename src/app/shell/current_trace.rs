//! Traceability of the next inspection: serial number, production order and operator, typed in the operator's view or sent by
//! a scanner.

use std::sync::{Arc, Mutex};

use egui::{Align2, TextEdit, Ui, WidgetInfo, vec2};

use crate::{
    app::{language::text, shell::session::Session, ui::theme::space},
    error::lock,
    history::Traceability,
};

/// Width of the label before a field, logical pixels.
const NAME: f32 = 76.0;

/// Traceability of the next inspection. Clones share it; whoever inspects takes it when the verdict counts.
#[derive(Clone, Debug, Default)]
pub struct CurrentTrace(Arc<Mutex<EnteredTrace>>);

#[derive(Debug, Default)]
struct EnteredTrace {
    trace: Traceability,
    /// True unless the serial number is still being typed.
    is_complete: bool,
}

impl CurrentTrace {
    /// Starts with these values.
    pub fn starting(trace: Traceability) -> Self {
        let is_complete = false;
        Self(Arc::new(Mutex::new(EnteredTrace { trace, is_complete })))
    }

    /// The current values.
    pub fn get(&self) -> Traceability {
        lock(&self.0).trace.clone()
    }

    /// The values kept from one start to the next: all but the serial number.
    pub fn remembered(&self) -> Traceability {
        Traceability {
            serial: String::new(),
            ..self.get()
        }
    }

    /// Sets the serial number of the part that hangs there, from a scanner or typed.
    pub fn set_serial(&self, serial: &str) {
        let mut entered = lock(&self.0);
        entered.trace.serial = Traceability::cleaned(serial);
        entered.is_complete = true;
    }

    /// The user has left the field of the serial number.
    fn complete(&self) {
        lock(&self.0).is_complete = true;
    }

    /// True if a complete serial number waits for its part.
    pub(in crate::app) fn has_complete_serial(&self) -> bool {
        let entered = lock(&self.0);
        entered.is_complete && !Traceability::cleaned(&entered.trace.serial).is_empty()
    }

    /// Takes a complete serial number for a part whose verdict has already counted; empty if there is none.
    pub(in crate::app) fn take_late_serial(&self) -> String {
        let mut entered = lock(&self.0);
        if !entered.is_complete {
            return String::new();
        }
        Traceability::cleaned(&std::mem::take(&mut entered.trace.serial))
    }

    /// Replaces an entry by an edited text, unless it has changed since the user saw it as `before`: a serial number that was
    /// taken meanwhile must not come back for the next part.
    fn edit(&self, entry: TraceEntry, before: &str, text: String) {
        let mut entered = lock(&self.0);
        let serial = entered.trace.serial.clone();
        let known = entry(&mut entered.trace);
        if *known == before {
            *known = text;
        }
        if entered.trace.serial != serial {
            entered.is_complete = false;
        }
    }

    /// Takes the values for an inspection. Uses up the serial number, so that the next part never gets it; if no part was
    /// found, the number waits for one.
    pub fn take(&self, is_part: bool) -> Traceability {
        let trace = &mut lock(&self.0).trace;
        let serial = if is_part {
            std::mem::take(&mut trace.serial)
        } else {
            String::new()
        };
        Traceability {
            serial: Traceability::cleaned(&serial),
            order: Traceability::cleaned(&trace.order),
            operator: Traceability::cleaned(&trace.operator),
        }
    }
}

/// One of the entries.
type TraceEntry = fn(&mut Traceability) -> &mut String;

/// Draws the input fields.
pub(in crate::app) fn fields(ui: &mut Ui, session: &Session) {
    let trace = &session.trace;
    let entries: [(String, String, TraceEntry); 3] = [
        (
            text!("operator-serial"),
            text!("operator-serial-hint"),
            |trace| &mut trace.serial,
        ),
        (text!("operator-order"), String::new(), |trace| {
            &mut trace.order
        }),
        (text!("operator-operator"), String::new(), |trace| {
            &mut trace.operator
        }),
    ];
    for (name, says, entry) in entries {
        let before = std::mem::take(entry(&mut trace.get()));
        let mut text = before.clone();
        let field = ui.horizontal(|ui| {
            ui.set_min_height(space::TARGET);
            let from = ui.cursor().left();
            let label = ui.label(egui::RichText::new(&name).weak());
            ui.add_space((from + NAME - ui.cursor().left()).max(0.0));
            let field = TextEdit::singleline(&mut text)
                .hint_text(says)
                .char_limit(Traceability::MAX_LETTERS)
                .align(Align2::LEFT_CENTER)
                .desired_width(f32::INFINITY)
                .min_size(vec2(0.0, space::TARGET));
            let field = ui.add(field).labelled_by(label.id);
            field.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, &name));
            field
        });
        if text != before {
            trace.edit(entry, &before, text);
        }
        if field.inner.lost_focus() {
            trace.complete();
        }
    }
    if !trace.get().serial.trim().is_empty() && session.serial_is_for_next() {
        let says = egui::RichText::new(text!("operator-serial-for-next"));
        ui.label(says.small().weak());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_serial_number_that_is_taken_while_a_field_is_edited_does_not_come_back() {
        let current = CurrentTrace::default();
        current.set_serial("4711");
        assert_eq!(current.take(true).serial, "4711");
        // Both fields were drawn before that.
        current.edit(|trace| &mut trace.serial, "4711", "47112".into());
        current.edit(|trace| &mut trace.order, "", "A 17".into());
        let left = current.get();
        assert_eq!((&*left.serial, &*left.order), ("", "A 17"));
    }

    #[test]
    fn a_serial_number_is_of_one_part_and_order_and_operator_of_many() {
        let current = CurrentTrace::starting(Traceability {
            serial: String::new(),
            order: "A 17".into(),
            operator: "Kim".into(),
        });
        current.set_serial(" 4711\n");
        assert_eq!(current.take(false).serial, "");
        let first = current.take(true);
        assert_eq!((&*first.serial, &*first.order), ("4711", "A 17"));
        let second = current.take(true);
        assert_eq!((&*second.serial, &*second.operator), ("", "Kim"));
    }
}
