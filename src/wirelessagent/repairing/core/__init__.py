"""What the repairers share: users' levels, neighbours in frequency, correlation between users, honest variances."""
