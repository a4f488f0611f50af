"""Many designs of one machine: which ones, how they are bound to its file, and what is answered of all of them."""
