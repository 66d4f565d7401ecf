use super::*;
#[test]
fn look() {
    use std::io::Write;
    for num in 2..=5 {
        for kind in RackKind::ALL {
            let t = std::time::Instant::now();
            let mut zs = vec![];
            let mut low = 1.0f64;
            let mut full = 0;
            let mut all = 0;
            let mut shares = vec![];
            for seed in 0..6 {
                let mut setup = RackSetup::drawn(kind, num, 0, seed).unwrap();
                if seed == 1 {
                    setup.cell.stand = Stand::Post;
                }
                let f = rack_frame(&setup).unwrap();
                for p in &f.truth.parts {
                    zs.push((p.camera_from_part.translation.z * 100.0) as i64);
                    low = low.min(p.visible_share);
                    full += p.fully_visible as usize;
                    all += 1;
                    if p.visible_share < 0.99 {
                        shares.push((p.visible_share * 100.0) as i64);
                    }
                }
                if seed < 2 {
                    let path = format!("/tmp/rackpix/{}-{num}-{seed}", kind.name());
                    let b: Vec<u8> = f
                        .truth
                        .labels
                        .iter()
                        .map(|l| match l {
                            SurfaceLabel::RackPart(n) => 10 + n,
                            SurfaceLabel::Stand => 1,
                            SurfaceLabel::Floor => 2,
                            SurfaceLabel::Wall => 3,
                            SurfaceLabel::Clutter => 4,
                            _ => 0,
                        })
                        .collect();
                    std::fs::File::create(format!("{path}.lab"))
                        .unwrap()
                        .write_all(&b)
                        .unwrap();
                    let d: Vec<u8> = f.frame.depth.iter().flat_map(|d| d.to_le_bytes()).collect();
                    std::fs::File::create(format!("{path}.dep"))
                        .unwrap()
                        .write_all(&d)
                        .unwrap();
                }
            }
            println!(
                "{num} {:12} z {}..{} low {low:.2} full {full}/{all} {:?} {shares:?}",
                kind.name(),
                zs.iter().min().unwrap(),
                zs.iter().max().unwrap(),
                t.elapsed() / 6
            );
        }
    }
}
