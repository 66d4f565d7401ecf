# The server that robots ask

open-to-network = { $at } is open to the network without encryption: whoever reaches it can trigger inspections and read poses
    .advice = Use a separate network for the cell, and let the firewall admit only the robot and the PLC to this port
numbers-not-stored = numbers of parts cannot be stored, and change when a part is added or removed: { $reason }
