# Viridis (S. van der Walt, N. Smith 2015): evenly spaced to the eye, also in
# gray and for the color-blind. From light to dark; before it, white.
viridis = "0.05 '#fde725', 0.16 '#addc30', 0.27 '#5ec962', 0.38 '#28ae80', ".\
  "0.49 '#21918c', 0.60 '#2c728e', 0.71 '#3b528b', 0.82 '#472d7b', 1 '#440154'"
