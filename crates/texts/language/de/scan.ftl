# Warum ein Bild eines Scans ausgelassen wird

excluded-wrong-pose = die Pose ist falsch: Das Bild passt { MM($shift_m, 1) } mm und { DEGREES($turn_rad, 2) }° daneben
    .advice = Prüfen, ob diese Pose zu diesem Bild gehört, und das Bild bei ruhendem Arm erneut aufnehmen
    .short = falsche Pose
excluded-contradicts = sie widerspricht den anderen Bildern: { PERCENT($share, 0) } % des gemeinsam Gesehenen stimmen überein
    .advice = { excluded-wrong-pose.advice }
    .short = Widerspruch zu den anderen Bildern
excluded-looked-past = sie widerspricht den anderen Bildern: Eines blickt an { PERCENT($share, 1) } % dessen vorbei, was beide sehen müssten
    .advice = { excluded-wrong-pose.advice }
    .short = { excluded-contradicts.short }
excluded-overlaps-none = sie überlappt keine andere Aufnahme, daher lässt sich ihre Pose nicht prüfen
    .advice = Prüfen, ob diese Pose zu diesem Bild gehört, oder eine Aufnahme hinzufügen, die Fläche von dieser und von einer anderen zeigt
    .short = überlappt keine andere
excluded-part-moved = das Teil hat sich bewegt: Die Zelle stimmt mit den anderen Bildern überein, vom Teil nur { PERCENT($share, 0) } %
    .advice = Das Bild bei stillstehendem Teil erneut aufnehmen
    .short = Teil bewegt

# Frames of a scan
left-out = { $name } wird ausgelassen: { $why }
no-part-in-frame = kein Teil gefunden
