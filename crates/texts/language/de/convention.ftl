# Wie Posen geschrieben werden, und warum ein Text oder Zahlen keine Pose sind

convention = { $convention ->
       *[matrix] Matrix, 4×4
        [quaternion-xyzw] Quaternion x y z w
        [rotation-vector] Rotationsvektor
        [kuka] KUKA A B C
        [fanuc] FANUC W P R
        [abb] ABB q1 q2 q3 q4
        [universal-robots] Universal Robots
        [yaskawa] Yaskawa Rx Ry Rz
        [staubli] Stäubli rx ry rz
        [doosan] Doosan A B C
    }
    .meaning = { $convention ->
       *[matrix] 4×4-Matrix, Zeile für Zeile: 3×3-Drehung mit x y z in Metern als vierter Spalte, dann 0 0 0 1; sie multipliziert eine Spalte [x y z 1] von links
        [quaternion-xyzw] x y z in Metern, dann ein Einheitsquaternion qx qy qz qw, der Skalar qw zuletzt und nicht negativ
        [rotation-vector] x y z in Metern, dann rx ry rz: die Drehachse mal dem Drehwinkel in Radiant, 0 bis π; nicht drei Winkel nacheinander
        [kuka] X Y Z in Millimetern, dann A B C in Grad: A um Z, B um das neue Y, C um das neue X (intrinsisch Z-Y'-X''), R = Rz(A)·Ry(B)·Rx(C), B innerhalb von ±90
        [fanuc] X Y Z in Millimetern, dann W P R in Grad: W um das feste X, dann P um das feste Y, dann R um das feste Z (extrinsisch X-Y-Z), R = Rz(R)·Ry(P)·Rx(W), P innerhalb von ±90
        [abb] x y z in Millimetern, dann ein Einheitsquaternion q1 q2 q3 q4, der Skalar q1 zuerst und nicht negativ, wie pos und orient in RAPID
        [universal-robots] x y z in Metern, dann rx ry rz: die Drehachse mal dem Drehwinkel in Radiant, 0 bis π, wie p[x, y, z, rx, ry, rz] in URScript; nicht Roll, Pitch und Yaw des Bediengeräts
        [yaskawa] X Y Z in Millimetern, dann Rx Ry Rz in Grad: Rx um das feste X, dann Ry um das feste Y, dann Rz um das feste Z (extrinsisch X-Y-Z), R = Rz(Rz)·Ry(Ry)·Rx(Rx), Ry innerhalb von ±90
        [staubli] x y z in Millimetern, dann rx ry rz in Grad: rx um X, ry um das neue Y, rz um das neue Z (intrinsisch X-Y'-Z''), R = Rx(rx)·Ry(ry)·Rz(rz), ry innerhalb von ±90, wie trsf in VAL 3
        [doosan] X Y Z in Millimetern, dann A B C in Grad: A um Z, B um das neue Y, C um das neue Z (intrinsisch Z-Y'-Z''), R = Rz(A)·Ry(B)·Rz(C), B von 0 bis 180, wie posx
    }

written-no-such-convention = keine Konvention heißt { $name }
    .advice = Zuerst die Konvention schreiben, zum Beispiel „kuka 1450 -310 890 10 20 30“: { $names }
written-no-convention = { $found ->
        [one] { $found } Zahl ohne den Namen einer Konvention
       *[other] { $found } Zahlen ohne den Namen einer Konvention
    }
    .advice = { written-no-such-convention.advice }
written-no-number = { $word } ist keine Zahl
    .advice = Zahlen mit Punkt schreiben, durch Leerzeichen getrennt
written-too-far = die Position ist { FIXED($distance_m, 0) } m entfernt, erwartet werden höchstens { $most } m
    .advice = Ihre Position in { $unit } schreiben, der Einheit von { $name }
written-nozzle = die Düse ist { MM($distance_m, 3) } mm vom Flansch entfernt, erwartet werden { MM($from_m, 0) } bis { MM($to_m, 0) } mm
    .advice = Ihre Position in { $unit } schreiben, der Einheit von { $name }; 0 0 0 nur, wenn das Flanschkoordinatensystem der Steuerung schon an der Düse liegt
written-count = { convention } hat { $needed } Zahlen ({ $names }), angegeben sind { $found }
    .advice = In dieser Reihenfolge angeben: { convention.meaning }
written-not-finite = { $name } ist { $value }, erwartet wird eine endliche Zahl
    .advice = Die Zahlen erneut von der Steuerung ablesen
written-not-unit = die Länge des Quaternions ist { FIXED($length, 4) }, erwartet wird 1
    .advice = Alle vier Zahlen mit mindestens 4 Nachkommastellen übernehmen und prüfen, welche davon der Skalar ist
written-long-rotation = die Länge des Rotationsvektors ist { FIXED($length, 2) }, erwartet wird höchstens 2π
    .advice = Den Rotationsvektor in Radiant angeben; diese Zahlen sehen nach Grad aus
written-not-rigid = die 16 Zahlen sind keine starre Transformation: Sie strecken, spiegeln oder enden nicht mit 0 0 0 1
    .advice = Eine Drehung und eine Verschiebung angeben, Zeile für Zeile mit mindestens 4 Nachkommastellen; Zeilen und Spalten nicht vertauschen
