"""What is neither skin nor hair: eyeballs, teeth, tongue, linings."""
