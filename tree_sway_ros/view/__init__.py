"""What is drawn: pictures of a tree and of its motion."""
