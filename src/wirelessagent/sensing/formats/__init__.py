"""File formats: each file here turns bytes into named arrays, and knows nothing of channels."""
