## Robot programs
program-files = Robot programs
program-no-nozzle = The arm's reach cannot be checked without the nozzle's place on the flange
program-no-nozzle-advice = Write it in Paint, below the arm, or choose no arm
program-not-written = No program was written: { $why }
program-written = { $count ->
        [one] Wrote { $path }: { $count } point as { $format }
       *[other] Wrote { $path }: { $count } points as { $format }
    }
program-written-parts = { $parts ->
        [one] Wrote { $path } and { $parts } program that it calls: { $count } points as { $format }; the controller needs both
       *[other] Wrote { $path } and { $parts } programs that it calls: { $count } points as { $format }; the controller needs all of them
    }
