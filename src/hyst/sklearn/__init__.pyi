from hyst.sklearn.regressor import HysteresisRegressor as HysteresisRegressor
