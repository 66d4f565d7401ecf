# Boxes of files

box-number = { $field } of { $name } is { $found }
    .advice = Correct the numbers
box-thin = no side of { $name } is { $least } mm or longer: its size_mm is { $found }
    .advice = Give its sides in millimetres

# Why a rack cannot be read, written or used

rack-file = { $what }
    .advice = { $to_do }
rack-garbled = { $path } is not a rack: { $why }
    .advice = Correct the file; the guide shows one (docs/guide/racks.md)
rack-not-enrolled = place "{ $place }" of the rack is for { $name }, which is not enrolled
    .advice = Enrol the part, or correct its name at the place
    .command-advice = Enrol the part, or correct its name in the rack file; partsight library list shows the names
rack-not-calibrated = the rack is given in the robot's base frame, and the cell is not calibrated
    .advice = Calibrate the cell, or give the rack in the camera's frame
    .command-advice = Name a calibration with --calibration, or set one in the window; or give the rack in camera space

## What is wrong with it

rack-toml = { $what }
rack-boxes = { $found } boxes of volume, expected at most { $limit }
rack-places = { $found } places, expected at most { $limit }
rack-empty = neither a volume nor a place
rack-name = { $is_place ->
        [true] a place's name must have 1 to { $limit } printable characters
       *[false] its name must have 1 to { $limit } printable characters
    }
rack-same-name = two places are called "{ $place }"
rack-overlap = places "{ $place }" and "{ $over }" overlap
rack-max-turn = max_turn_deg of place "{ $place }" is { $found }, expected more than 0, up to 180
