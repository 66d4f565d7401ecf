# In English, the texts of coats and their parameters are in the tables of the library.
