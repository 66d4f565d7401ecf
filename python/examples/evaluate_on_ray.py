"""Evaluates a folder of kept cases on a Ray cluster: python evaluate_on_ray.py CASES STORE [LIBRARY [WORKERS]]

STORE is a folder, or a URI such as s3://bucket/monday, that every machine of the cluster reaches; LIBRARY is a folder that
lies under the same path on all of them. Without a cluster (ray start, RAY_ADDRESS) one starts on this machine. Started
again after it was stopped, it goes on where it was.
"""

import sys

from partsight import PartsightError, evaluate

if not 3 <= len(sys.argv) <= 5:
    sys.exit(__doc__)
cases, store = sys.argv[1:3]
library = sys.argv[3] if len(sys.argv) > 3 else None
workers = int(sys.argv[4]) if len(sys.argv) > 4 else None

try:
    print(evaluate.pack(cases, f"{store}/cases"), "cases packed")
except PartsightError as error:
    if "holds packed cases" not in str(error):
        sys.exit(str(error))
report = evaluate.run_on_ray(f"{store}/cases", f"{store}/results", library, workers=workers)
print(report.text)
