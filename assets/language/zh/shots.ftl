# shots
