# How poses are written down, and why a text or numbers are no pose

convention = { $convention ->
       *[matrix] Matrix, 4×4
        [quaternion-xyzw] Quaternion x y z w
        [rotation-vector] Rotation vector
        [kuka] KUKA A B C
        [fanuc] FANUC W P R
        [abb] ABB q1 q2 q3 q4
        [universal-robots] Universal Robots
        [yaskawa] Yaskawa Rx Ry Rz
        [staubli] Stäubli rx ry rz
        [doosan] Doosan A B C
    }
    .meaning = { $convention ->
       *[matrix] 4×4 matrix, row after row: 3×3 rotation with x y z in metres as the fourth column, then 0 0 0 1; it multiplies a column [x y z 1] from the left
        [quaternion-xyzw] x y z in metres, then a unit quaternion qx qy qz qw with the scalar qw last and not negative
        [rotation-vector] x y z in metres, then rx ry rz: the axis of the rotation times its angle in radians, 0 to π; not three angles one after the other
        [kuka] X Y Z in millimetres, then A B C in degrees: A about Z, B about the new Y, C about the new X (intrinsic Z-Y'-X''), R = Rz(A)·Ry(B)·Rx(C), B within ±90
        [fanuc] X Y Z in millimetres, then W P R in degrees: W about the fixed X, then P about the fixed Y, then R about the fixed Z (extrinsic X-Y-Z), R = Rz(R)·Ry(P)·Rx(W), P within ±90
        [abb] x y z in millimetres, then a unit quaternion q1 q2 q3 q4 with the scalar q1 first and not negative, as in RAPID's pos and orient
        [universal-robots] x y z in metres, then rx ry rz: the axis of the rotation times its angle in radians, 0 to π, as in URScript's p[x, y, z, rx, ry, rz]; not the roll, pitch and yaw of the teach pendant
        [yaskawa] X Y Z in millimetres, then Rx Ry Rz in degrees: Rx about the fixed X, then Ry about the fixed Y, then Rz about the fixed Z (extrinsic X-Y-Z), R = Rz(Rz)·Ry(Ry)·Rx(Rx), Ry within ±90
        [staubli] x y z in millimetres, then rx ry rz in degrees: rx about X, ry about the new Y, rz about the new Z (intrinsic X-Y'-Z''), R = Rx(rx)·Ry(ry)·Rz(rz), ry within ±90, as in VAL 3's trsf
        [doosan] X Y Z in millimetres, then A B C in degrees: A about Z, B about the new Y, C about the new Z (intrinsic Z-Y'-Z''), R = Rz(A)·Ry(B)·Rz(C), B from 0 to 180, as in posx
    }

written-no-such-convention = no convention is named { $name }
    .advice = Write the convention first, for example "kuka 1450 -310 890 10 20 30": { $names }
written-no-convention = { $found ->
        [one] { $found } number without the name of a convention
       *[other] { $found } numbers without the name of a convention
    }
    .advice = { written-no-such-convention.advice }
written-no-number = { $word } is not a number
    .advice = Write numbers with a point, separated by spaces
written-too-far = the position is { FIXED($distance_m, 0) } m away, expected at most { $most } m
    .advice = Write its position in { $unit }, the unit of { $name }
written-nozzle = the nozzle is { MM($distance_m, 3) } mm from the flange, expected { MM($from_m, 0) } to { MM($to_m, 0) } mm
    .advice = Write its position in { $unit }, the unit of { $name }; 0 0 0 only if the controller's flange frame already is at the nozzle
written-count = { convention } has { $needed } numbers ({ $names }), { $found } are given
    .advice = Give them in this order: { convention.meaning }
written-not-finite = { $name } is { $value }, expected a finite number
    .advice = Read the numbers off the controller again
written-not-unit = the quaternion's length is { FIXED($length, 4) }, expected 1
    .advice = Copy all four numbers with at least 4 decimals, and check which of them is the scalar
written-long-rotation = the rotation vector has length { FIXED($length, 2) }, expected at most 2π
    .advice = Give the rotation vector in radians; these look like degrees
written-not-rigid = the 16 numbers are not a rigid transform: they stretch, mirror or do not end in 0 0 0 1
    .advice = Give a rotation and a shift, row after row with at least 4 decimals; check rows against columns
