## Robot programs
program-files = Robot programs
program-no-nozzle = The arm's reach cannot be checked without the nozzle's place on the flange
program-no-nozzle-advice = Write it in Paint, below the arm, or choose no arm
program-stale = Nothing was written: the capture is more than 10 minutes old
program-stale-advice = Capture the part again
program-clock-ahead = Nothing was written: the capture is dated { $seconds } s later than now, so its age is not known
program-clock-ahead-advice = Set the clocks of this computer and of the one that wrote the capture from the same time server, and capture the part again
program-ambiguous = Nothing was written: another pose of the part fits as well
program-ambiguous-advice = Capture all of the part again, so that only one pose fits
program-off-part = No program was written: the spray path does not aim at the part (only { $aiming } of { $all } points with the gun on)
program-off-part-advice = Check that the path is that of this part, or plan and store a new one in Paint
program-not-reached = No program was written: { $arm } misses { $missed } of { $all } points
program-not-reached-advice = Move the part or the arm's base, or change the path
program-film-off-plan = No program was written: it would bring { $written } % of the surface within { $tolerance } % of the target with { $written_um } µm on average, where { $planned } % and { $planned_um } µm were planned; with the gun open it would stop { $stops } times
program-film-off-plan-advice = Plan the path without added strokes along flanks (Lean to flanks 0), or write it for a controller that switches the gun while the robot moves
program-written = Wrote { $path }: { $count } points as { $format }
program-written-parts = Wrote { $path } and { $parts } programs that it calls: { $count } points as { $format }; the controller needs all of them
