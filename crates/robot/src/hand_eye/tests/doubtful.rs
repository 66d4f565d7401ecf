//! Pairs that must not be trusted, and their doubts.

use super::*;

#[test]
fn half_turns_about_axes_at_right_angles_alone_have_several_answers() {
    over_cells(10, |cell, random| {
        let half = std::f64::consts::PI;
        let turns = [[0.0, 0.0], [half, 0.0], [0.0, half], [half, half]];
        let pairs: Vec<PosePair> = (0..8)
            .map(|i| {
                let [rx, ry] = turns[i % 4];
                let seen = from_euler_zyx([rx, ry, 0.0, 0.03 * i as f64, 0.1, 1.2]);
                let mut pair = cell.pair(i, seen);
                pair.camera_from_target = with_noise(&seen, noise(0.2, 0.05), random);
                pair
            })
            .collect();
        // Which of the solutions is found is chance; there may be none at all.
        match solve(&pairs, cell.mount) {
            Ok(found) => {
                assert_eq!(found.doubts.first(), Some(&HandEyeDoubt::SeveralAnswers));
            }
            Err(error) => assert_eq!(error, HandEyeError::Unsolvable),
        }
    });
}

/// Pairs with turns about one axis of the flange only.
fn about_one_axis(cell: &TrueCell, axis: Vector3<f64>, num: usize) -> Vec<PosePair> {
    (0..num)
        .map(|i| {
            let angle = 0.25 * i as f64;
            let turn = UnitQuaternion::from_scaled_axis(axis * angle);
            let base = cell.pair(i, from_euler_zyx([0.1, 0.2, 0.3, 0.1 * i as f64, 0.0, 1.2]));
            let flange = Isometry3::from_parts(
                base.robot_from_flange.translation,
                UnitQuaternion::from_euler_angles(0.5, 0.1, -0.8) * turn,
            );
            let carrier = cell.mount.carrier(&flange);
            PosePair {
                robot_from_flange: flange,
                camera_from_target: (carrier * cell.mount_from_camera)
                    .inv_mul(&cell.anchor_from_target),
                ..base
            }
        })
        .collect()
}

#[test]
fn turns_about_one_axis_are_told_with_the_axis() {
    over_cells(10, |cell, _| {
        let found = solve(&about_one_axis(&cell, Vector3::z(), 8), cell.mount).expect("a result");
        let doubt = found.doubts.first().expect("a doubt");
        assert!(matches!(doubt, HandEyeDoubt::OneAxis { .. }), "{doubt}");
        assert!(doubt.to_string().contains("the flange's z axis"), "{doubt}");
        assert!(
            doubt.advice().contains("another axis"),
            "{}",
            doubt.advice()
        );
        assert!(!found.is_usable());
    });
}

#[test]
fn poses_that_hardly_differ_are_told() {
    over_cells(10, |cell, random| {
        let pairs = cell.pairs(8, 0.05, EXACT, random);
        let found = solve(&pairs, cell.mount).expect("a result");
        let is_small = |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::SmallTurns { .. });
        assert!(found.doubts.iter().any(is_small), "{:?}", found.doubts);
        assert!(!found.is_usable());
    });
    let cell = TrueCell::any(Mount::EyeInHand, &mut Pcg64::seed_from_u64(1));
    let same = vec![cell.pair(1, from_euler_zyx([0.0, 0.0, 0.0, 0.0, 0.0, 1.2])); 5];
    if let Ok(found) = solve(&same, cell.mount) {
        assert!(!found.is_usable());
        assert!(found.bounds.shift.0.is_infinite() || found.bounds.shift.0 < 1e-6);
    }
}

#[test]
fn too_little_travel_and_too_few_pairs_are_told_and_do_not_stop_anything() {
    let mut random = Pcg64::seed_from_u64(3);
    let cell = TrueCell::any(Mount::EyeToHand, &mut random);
    let pairs: Vec<PosePair> = (0..4)
        .map(|i| {
            let turn = any_rotation(&mut random, 0.9);
            cell.pair(
                i,
                Isometry3::from_parts(Translation3::new(0.0, 0.0, 1.2), turn),
            )
        })
        .collect();
    let found = solve(&pairs, cell.mount).expect("solved");
    assert!(found.is_usable(), "{:?}", found.doubts);
    let has = |is: fn(&HandEyeDoubt) -> bool| found.doubts.iter().any(is);
    assert!(has(|d| matches!(d, HandEyeDoubt::LittleTravel { .. })));
    assert!(has(|d| matches!(d, HandEyeDoubt::FewPairs { found: 4 })));
    assert_eq!(
        solve(&pairs[..2], cell.mount),
        Err(HandEyeError::TooFewPairs { found: 2 })
    );
}

#[test]
fn a_gross_outlier_is_named_and_nothing_else() {
    over_cells(60, |cell, random| {
        let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        let wrong = random.random_range(0..10);
        // The arm's pose of another capture, or an error of some centimetres.
        let slip = Translation3::new(0.03, -0.02, 0.01);
        pairs[wrong].robot_from_flange = if wrong % 2 == 0 {
            slip * pairs[wrong].robot_from_flange
        } else {
            pairs[wrong].robot_from_flange * any_rotation(random, 0.3)
        };
        if wrong % 2 == 1 {
            pairs[wrong].robot_from_flange = slip * pairs[wrong].robot_from_flange;
        }
        let found = solve(&pairs, cell.mount).expect("solved");
        let named: Vec<&str> = found
            .doubts
            .iter()
            .filter_map(|doubt| match doubt {
                HandEyeDoubt::Suspect { pair, .. } => Some(pair.as_str()),
                _ => None,
            })
            .collect();
        assert_eq!(named, [pairs[wrong].name.as_str()], "{:?}", found.doubts);
        pairs.remove(wrong);
        let without = solve(&pairs, cell.mount).expect("solved");
        assert!(
            cell.off(&without).shift.mm() < 6.0,
            "{:?}",
            cell.off(&without)
        );
        assert!(without.doubts.is_empty(), "{:?}", without.doubts);
    });
}

#[test]
fn sound_pairs_are_not_suspected() {
    let mut suspected = 0;
    over_cells(150, |cell, random| {
        let found = solve(&cell.pairs(12, 0.7, noise(1.0, 0.2), random), cell.mount);
        let found = found.expect("solved");
        let is_suspect = |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::Suspect { .. });
        suspected += usize::from(found.doubts.iter().any(is_suspect));
        assert!(found.is_usable(), "{:?}", found.doubts);
    });
    assert!(suspected <= 3, "{suspected} of 300");
}

#[test]
fn poses_the_wrong_way_round_are_told() {
    over_cells(20, |cell, random| {
        let sound = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        let reply = |pairs: &[PosePair]| match solve(pairs, cell.mount) {
            Ok(found) => found.doubts.first().cloned(),
            Err(error) => panic!("{error}"),
        };
        for (wrong, expected) in [
            ([true, false], LikelyMistake::RobotInverted),
            ([false, true], LikelyMistake::CameraInverted),
        ] {
            let mut pairs = sound.clone();
            for pair in &mut pairs {
                if wrong[0] {
                    pair.robot_from_flange.inverse_mut();
                }
                if wrong[1] {
                    pair.camera_from_target.inverse_mut();
                }
            }
            let doubt = reply(&pairs);
            assert!(
                matches!(doubt, Some(HandEyeDoubt::Mistaken { mistake, .. }) if mistake == expected),
                "{expected:?}: {doubt:?}"
            );
        }
    });
}

#[test]
fn both_poses_the_wrong_way_round_put_something_far_from_the_flange() {
    over_cells(20, |mut cell, random| {
        let far = from_euler_zyx([0.4, 0.2, -1.0, 1.4, -0.6, 0.9]);
        match cell.mount {
            Mount::EyeToHand => cell.mount_from_camera = far,
            Mount::EyeInHand => cell.anchor_from_target = far,
        }
        let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        assert!(solve(&pairs, cell.mount).expect("solved").is_usable());
        for pair in &mut pairs {
            pair.robot_from_flange.inverse_mut();
            pair.camera_from_target.inverse_mut();
        }
        let found = solve(&pairs, cell.mount).expect("solved");
        assert!(
            matches!(
                found.doubts.first(),
                Some(HandEyeDoubt::FarFromFlange { .. })
            ),
            "{:?}",
            found.doubts
        );
    });
}

/// Cells whose lengths are those of small arms: what is on the flange is near it, what is in the cell within reach. The
/// target's z axis points away from the camera, or towards it.
fn small_cells(num: u64, mut check: impl FnMut(&TrueCell, Vec<PosePair>)) {
    over_cells(num, |mut cell, random| {
        let mut pose = |from: f64, to: f64| {
            let shift = normals(random, 1.0).normalize() * random.random_range(from..to);
            Isometry3::from_parts(Translation3::from(shift), any_rotation(random, 3.1))
        };
        let (near, far) = (pose(0.05, 0.25), pose(0.35, 1.15));
        [cell.mount_from_camera, cell.anchor_from_target] = match cell.mount {
            Mount::EyeInHand => [near, far],
            Mount::EyeToHand => [far, near],
        };
        let towards = if random.random() {
            0.0
        } else {
            std::f64::consts::PI
        };
        let pairs = (0..10).map(|number| {
            let [x, y] = [0.12, 0.1].map(|most| random.random_range(-most..most));
            let shift = Translation3::new(x, y, random.random_range(0.4..0.7));
            let turn = any_rotation(random, 0.7)
                * from_euler_zyx([towards, 0.0, 0.0, 0.0, 0.0, 0.0]).rotation;
            let seen = Isometry3::from_parts(shift, turn);
            let mut pair = cell.pair(number, seen);
            pair.camera_from_target = with_noise(&seen, noise(0.3, 0.1), random);
            pair
        });
        let pairs = pairs.collect();
        check(&cell, pairs);
    });
}

#[test]
fn both_poses_the_wrong_way_round_are_named_and_sound_ones_are_not_refused() {
    let (mut named, mut refused, mut num) = (0, 0, 0);
    small_cells(40, |cell, mut pairs| {
        let found = solve(&pairs, cell.mount).expect("solved");
        refused += usize::from(!found.is_usable());
        for pair in &mut pairs {
            pair.robot_from_flange.inverse_mut();
            pair.camera_from_target.inverse_mut();
        }
        let found = solve(&pairs, cell.mount).expect("solved");
        assert!(!found.is_usable());
        let doubt = found.doubts[0].to_string();
        named += usize::from(doubt.contains("both went the other way"));
        num += 1;
    });
    assert_eq!([num, named, refused], [80, 80, 0]);
}

#[test]
fn a_target_behind_the_camera_is_refused() {
    small_cells(10, |cell, mut pairs| {
        // The frame of a camera that looks along -z, as in computer graphics: the pairs agree.
        let turned = from_euler_zyx([std::f64::consts::PI, 0.0, 0.0, 0.0, 0.0, 0.0]);
        for pair in &mut pairs {
            pair.camera_from_target = turned * pair.camera_from_target;
        }
        let found = solve(&pairs, cell.mount).expect("solved");
        let (behind, of_all) = (10, 10);
        let expected = HandEyeDoubt::BehindCamera {
            behind,
            found: of_all,
        };
        assert_eq!(found.doubts.first(), Some(&expected));
    });
}

#[test]
fn quaternions_with_the_scalar_at_the_other_end_are_named() {
    let moved = |pose: &mut RigidTransform, scalar_was_last: bool| {
        let written = pose.rotation;
        let read = if scalar_was_last {
            nalgebra::Quaternion::new(written.i, written.j, written.k, written.w)
        } else {
            nalgebra::Quaternion::new(written.k, written.w, written.i, written.j)
        };
        pose.rotation = UnitQuaternion::new_normalize(read);
    };
    over_cells(20, |cell, random| {
        for (is_of_robot, scalar_was_last) in
            [(true, true), (true, false), (false, true), (false, false)]
        {
            let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
            for pair in &mut pairs {
                let pose = if is_of_robot {
                    &mut pair.robot_from_flange
                } else {
                    &mut pair.camera_from_target
                };
                moved(pose, scalar_was_last);
            }
            let found = solve(&pairs, cell.mount).expect("a result");
            let expected = if is_of_robot {
                LikelyMistake::RobotScalarMoved
            } else {
                LikelyMistake::CameraScalarMoved
            };
            let is_named = |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::Mistaken { mistake, .. } if *mistake == expected);
            let is_found = found.doubts.iter().any(is_named);
            assert!(is_found, "{expected:?}: {:?}", found.doubts);
            assert!(!found.is_usable());
        }
    });
}

#[test]
fn repeated_pairs_count_once() {
    over_cells(20, |cell, random| {
        for num in [3, 8] {
            let once = cell.pairs(num, 0.7, noise(0.5, 0.1), random);
            let of_once = solve(&once, cell.mount).expect("solved");
            let thrice = [&once[..], &once[..], &once[..]].concat();
            let found = solve(&thrice, cell.mount).expect("solved");
            let in_words = |solved: &HandEye| -> Vec<String> {
                solved.doubts.iter().map(ToString::to_string).collect()
            };
            assert_eq!(in_words(&found), in_words(&of_once));
            assert!((found.bounds.shift.0 - of_once.bounds.shift.0).abs() < 1e-9);
            assert_eq!(found.residuals.pairs.len(), 3 * num);
            // Several captures without a movement are no more poses of the arm either.
            let mut captured = thrice;
            for pair in &mut captured {
                pair.camera_from_target =
                    with_noise(&pair.camera_from_target, noise(0.3, 0.1), random);
            }
            let found = solve(&captured, cell.mount).expect("solved");
            let is_few =
                |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::FewPairs { found: 3 });
            assert_eq!(found.doubts.iter().any(is_few), num == 3);
        }
    });
    let cell = TrueCell::any(Mount::EyeInHand, &mut Pcg64::seed_from_u64(1));
    let mut random = Pcg64::seed_from_u64(2);
    let two = cell.pairs(2, 0.7, EXACT, &mut random);
    assert_eq!(
        solve(&[&two[..], &two[..]].concat(), cell.mount),
        Err(HandEyeError::TooFewPairs { found: 2 })
    );
}

#[test]
fn lengths_in_another_unit_are_told() {
    over_cells(20, |cell, random| {
        let sound = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        let scaled = |factor: f64| -> Vec<PosePair> {
            let scale = |pair: &PosePair| {
                let mut pair = pair.clone();
                pair.camera_from_target.translation.vector *= factor;
                pair
            };
            sound.iter().map(scale).collect()
        };
        let first = |pairs: &[PosePair]| solve(pairs, cell.mount).expect("solved").doubts.remove(0);
        let is_mistake = |doubt: &HandEyeDoubt, wanted: LikelyMistake| matches!(doubt, HandEyeDoubt::Mistaken { mistake, .. } if *mistake == wanted);
        let doubt = first(&scaled(0.001));
        assert!(is_mistake(&doubt, LikelyMistake::CameraInMetres), "{doubt}");
        assert!(matches!(
            first(&scaled(1000.0)),
            HandEyeDoubt::FarAway { .. }
        ));
        // The same factor between camera and robot, but the robot's poses are those of no arm.
        let mut small = sound.clone();
        for pair in &mut small {
            pair.robot_from_flange.translation.vector *= 0.001;
        }
        let doubt = first(&small);
        assert!(is_mistake(&doubt, LikelyMistake::RobotInMetres), "{doubt}");
        // If both are in metres, the pairs agree.
        for pair in &mut small {
            pair.camera_from_target.translation.vector *= 0.001;
        }
        let found = solve(&small, cell.mount).expect("solved");
        let is_near = |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::TooNear { .. });
        assert!(found.doubts.iter().any(is_near), "{:?}", found.doubts);
        assert!(!found.is_usable());
    });
}

#[test]
fn angles_of_another_makers_order_are_told() {
    use crate::Convention;

    over_cells(20, |cell, random| {
        for (written, read) in [
            (Convention::Kuka, Convention::Fanuc),
            (Convention::Yaskawa, Convention::Kuka),
        ] {
            let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
            for pair in &mut pairs {
                let numbers = written.write(&pair.robot_from_flange).values;
                let numbers: Vec<f64> = numbers.iter().map(|number| number.value).collect();
                pair.robot_from_flange = read.read(&numbers).expect("six numbers");
            }
            let found = solve(&pairs, cell.mount).expect("a result");
            let is_swap = |doubt: &&HandEyeDoubt| {
                matches!(
                    doubt,
                    HandEyeDoubt::Mistaken {
                        mistake: LikelyMistake::AnglesSwapped,
                        ..
                    }
                )
            };
            let doubt = found.doubts.iter().find(is_swap).map(ToString::to_string);
            let names_makers = doubt.is_some_and(|doubt| doubt.contains("FANUC's W P R"));
            assert!(names_makers, "{:?}", found.doubts);
            assert!(!found.is_usable());
        }
    });
}

#[test]
fn poses_that_do_not_belong_together_are_told() {
    over_cells(20, |cell, random| {
        let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        // Every robot pose is shifted by one line.
        let first = pairs[0].robot_from_flange;
        for i in 0..9 {
            pairs[i].robot_from_flange = pairs[i + 1].robot_from_flange;
        }
        pairs[9].robot_from_flange = first;
        let found = solve(&pairs, cell.mount).expect("a result");
        assert!(
            matches!(
                found.doubts.first(),
                Some(HandEyeDoubt::TurnsDisagree { .. })
            ),
            "{:?}",
            found.doubts
        );
    });
}

#[test]
fn a_number_that_is_not_finite_is_named() {
    let mut random = Pcg64::seed_from_u64(3);
    let cell = TrueCell::any(Mount::EyeToHand, &mut random);
    let mut pairs = cell.pairs(4, 0.7, EXACT, &mut random);
    pairs[2].camera_from_target.translation.vector.x = f64::NAN;
    let pair = pairs[2].name.clone();
    assert_eq!(
        solve(&pairs, cell.mount),
        Err(HandEyeError::NotFinite { pair })
    );
}
