"""What is shown: tables, figures and pages made from results and from the code itself."""
