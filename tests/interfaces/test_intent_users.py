"""Who gets what: rates, weights and service of single users, and limits of subcarriers, from words alone."""

from __future__ import annotations

from typing import Any

import pytest

from wirelessagent.language.as_meant import as_meant
from wirelessagent.language.constraints import read_constraints
from wirelessagent.language.intent import same_constraints
from wirelessagent.language.offline import recognise
from wirelessagent.language.quantities import parse_quantities
from wirelessagent.language.stated import Reading
from wirelessagent.language.text import normalise

STATED: list[tuple[str, dict[str, Any]]] = [
    ("user 3 at least 2 Mbit/s and everyone else 500 kbit/s", {"min_rate_bps": {"3": 2e6, "all": 5e5}}),
    ("2 Mbit/s for user 3 and 1 Mbit/s for user 5, max 10 W",
     {"max_power_w": 10.0, "min_rate_bps": {"3": 2e6, "5": 1e6}}),
    ("users 1 and 4 get 2 Mbit/s each", {"min_rate_bps": {"1": 2e6, "4": 2e6}}),
    ("1 Mbit/s each but users 2 and 3 should have 3 Mbit/s each", {"min_rate_bps": {"all": 1e6, "2": 3e6, "3": 3e6}}),
    ("the third user must have 2 Mbit/s", {"min_rate_bps": {"3": 2e6}}),
    ("give user 3 a 5 Mbit/s floor", {"min_rate_bps": {"3": 5e6}}),
    ("cap user 7 at 5 Mbit/s", {"max_rate_bps": {"7": 5e6}}),
    ("user 3 doesn't need more than 2 Mbit/s", {"max_rate_bps": {"3": 2e6}}),
    ("user3 and UE5 need 1 Mbps", {"min_rate_bps": {"3": 1e6, "5": 1e6}}),
    ("1号和2号用户至少2兆,其他人500k", {"min_rate_bps": {"1": 2e6, "2": 2e6, "all": 5e5}}),
    ("al menos 500 kbps por usuario y 2 Mbps para el usuario 4", {"min_rate_bps": {"all": 5e5, "4": 2e6}}),
    ("Nutzer 4 braucht mindestens 2 Mbit/s", {"min_rate_bps": {"4": 2e6}}),
    # "le un", "el uno" are user 1, and whoever an "and" joins to somebody named is somebody
    ("un mégabit au un", {"min_rate_bps": {"1": 1e6}}), ("le un plafonné à 2 mégabits", {"max_rate_bps": {"1": 2e6}}),
    ("du un au quatre un mégabit chacun", {"min_rate_bps": {"1": 1e6, "2": 1e6, "3": 1e6, "4": 1e6}}),
    ("al uno y al dos medio mega", {"min_rate_bps": {"1": 5e5, "2": 5e5}}), ("sin el uno", {"leave_out": ("1",)}),
    ("corte al uno por ciento", {"outage_probability": 0.01}),
    # what is said of somebody, and of another one, too
    ("le deux doit avoir un mégabit et le six aussi", {"min_rate_bps": {"2": 1e6, "6": 1e6}}),
    ("el tres no más de cinco megas y el siete tampoco", {"max_rate_bps": {"3": 5e6, "7": 5e6}}),
    ("user fünf ein megabit user sechs auch", {"min_rate_bps": {"5": 1e6, "6": 1e6}}),
    ("ohne nutzer 3, nutzer 4 auch", {"leave_out": ("3", "4")}),
    ("leave out user 3 and user 5 too", {"leave_out": ("3", "5")}),
    ("half a watt for each subcarrier", {"subcarrier_max_power_w": 0.5}),
    # so many times what another user gets
    ("user 1 gets 3 Mbit/s, user 2 half as much as user 1, user 3 half as much as user 2",
     {"min_rate_bps": {"1": 3e6, "2": 1.5e6, "3": 7.5e5}}),
    ("用户8的最低速率是用户1的三倍，用户1是400 kbit/s", {"min_rate_bps": {"1": 4e5, "8": 1.2e6}}),
    ("El 4 necesita el cuádruple que el 1. El 1 necesita 450 kbit/s", {"min_rate_bps": {"1": 4.5e5, "4": 1.8e6}}),
    ("l'utilisateur 7 doit avoir le triple de l'utilisateur 2, lequel doit avoir 520 kbit/s au moins",
     {"min_rate_bps": {"2": 5.2e5, "7": 1.56e6}}),
    ("cap user 1 at 2 Mbit/s and user 3 at twice that of user 1", {"max_rate_bps": {"1": 2e6, "3": 4e6}}),
    ("user 2 at least 1 Mbit/s, cap user 3 at twice what user 2 gets",
     {"min_rate_bps": {"2": 1e6}, "max_rate_bps": {"3": 2e6}}),
    ("l'utilisateur 6 au moins 800 kbit/s, l'utilisateur 1 ne doit pas dépasser le triple de l'utilisateur 6",
     {"min_rate_bps": {"6": 8e5}, "max_rate_bps": {"1": 2.4e6}}),
    ("2 Mbit/s for user 2, no guarantee for user 5, least power", {"min_rate_bps": {"2": 2e6}}),
    ("60毫瓦每个子载波", {"subcarrier_max_power_w": 0.06}), ("只服务用户一二到四号", {"users": ("1", "2", "3", "4")}),
    ("the others 500 kbit/s, user 3 as well", {"min_rate_bps": {"all": 5e5, "3": 5e5}}),
    # whom an "and" joins, and what it only counts
    ("users 3 and 4 more than 1 Mbit/s", {"min_rate_bps": {"3": 1e6, "4": 1e6}}),
    ("at least 2 Mbit/s for user 3 and 4 subcarriers per block",
     {"min_rate_bps": {"3": 2e6}, "resource_block_group_size": 4.0}),
    ("tope de dos megas al uno y al cuatro", {"max_rate_bps": {"1": 2e6, "4": 2e6}}),
    ("au moins 1 Mbit/s du un au quatre", {"min_rate_bps": {"1": 1e6, "2": 1e6, "3": 1e6, "4": 1e6}}),
    ("user 5 at least 2 Mbit/s, the others too", {"min_rate_bps": {"5": 2e6, "all": 2e6}}),
    ("nutzer drei und nutzer sieben, die zwei mit 1 Mbit/s", {"min_rate_bps": {"3": 1e6, "7": 1e6}}),
    ("用户1的权重是 5，3 号是 2", {"weights": {"1": 5.0, "3": 2.0}}),
    ("功率14瓦每个子载波最多60毫瓦", {"max_power_w": 14.0, "subcarrier_max_power_w": 0.06}),
    ("限速：1、2、3 号各 2 Mbit/s，4 号 3 Mbit/s", {"max_rate_bps": {"1": 2e6, "2": 2e6, "3": 2e6, "4": 3e6}}),
    # whoever goes without, in their own words; who is excepted has a limit of the same kind
    ("all users: 300 kbit/s guaranteed, except user 2 who has 2 Mbit/s and user 5 who has no guarantee",
     {"min_rate_bps": {"all": 3e5, "2": 2e6, "5": 0.0}}),
    ("un méga minimum pour tous sauf l'utilisateur huit qui n'a droit à aucune garantie",
     {"min_rate_bps": {"all": 1e6, "8": 0.0}}),
    ("plafond de 2,7 Mbit/s pour tout le monde, sauf l'utilisateur 2 qui est à 900 kbit/s",
     {"max_rate_bps": {"all": 2.7e6, "2": 9e5}}),
    ("只服务一三五号", {"users": ("1", "3", "5")}), ("预算留两成不动", {"max_power_w": 16.0}),
    ("ahorra potencia al máximo medio mega mínimo para todos", {"min_rate_bps": 5e5}),
    ("un incumplimiento de cada cien", {"outage_probability": 0.01}),
    ("a tenth of the power is off limits", {"max_power_w": 18.0}),
    ("30 % of the budget stays unused", {"max_power_w": 14.0}),
    ("un quart de la puissance reste en réserve", {"max_power_w": 15.0}),
    ("限速名单：5号、6号两位用户各1.6 Mbps", {"max_rate_bps": {"5": 1.6e6, "6": 1.6e6}}),
    # figures said once more
    ("circuits 5 W and yes, transmit 5 W", {"circuit_power_w": 5.0, "max_power_w": 5.0}),
    ("circuit 10 W (10 W transmit power)", {"circuit_power_w": 10.0, "max_power_w": 10.0}),
    # weights
    ("weight 2 for user 1 and 0.5 for user 4", {"weights": {"1": 2.0, "4": 0.5}}),
    ("user 5 counts twice, user 6 has weight 3", {"weights": {"5": 2.0, "6": 3.0}}),
    ("User 9 is the chief, so weigh her four times", {"weights": {"9": 4.0}}),
    ("weights 1 2 3 for users 1 2 3", {"weights": {"1": 1.0, "2": 2.0, "3": 3.0}}),
    ("users 1 2 3 have weights 3 2 1", {"weights": {"1": 3.0, "2": 2.0, "3": 1.0}}),
    ("weights 5, 1 and 3 for users 1, 2 and 3", {"weights": {"1": 5.0, "2": 1.0, "3": 3.0}}),
    ("2号、3号、5号的权重依次为4、2、1", {"weights": {"2": 4.0, "3": 2.0, "5": 1.0}}),
    ("1 2 3号用户权重 3 2 1", {"weights": {"1": 3.0, "2": 2.0, "3": 1.0}}),
    ("die Nutzer 1, 2 und 3 haben die Gewichte 1, 2 und 3", {"weights": {"1": 1.0, "2": 2.0, "3": 3.0}}),
    ("users 2-5 at least 1 Mbit/s", {"min_rate_bps": dict.fromkeys("2345", 1e6)}),
    ("2到5号用户至少1兆", {"min_rate_bps": dict.fromkeys("2345", 1e6)}),
    ("users 1 2 3 get 2 Mbit/s", {"min_rate_bps": dict.fromkeys("123", 2e6)}),
    ("serve users 1 2 and 4 only", {"users": ("1", "2", "4")}),
    ("users 1 2 Mbit/s", {"min_rate_bps": {"1": 2e6}}),
    ("用户4权重2,用户5权重0.5", {"weights": {"4": 2.0, "5": 0.5}}),
    ("5号权重翻倍", {"weights": {"5": 2.0}}),
    ("l'utilisateur 3 compte double", {"weights": {"3": 2.0}}),
    ("Nutzer 4 zählt doppelt", {"weights": {"4": 2.0}}),
    ("weight 3 for user 1, all others 1", {"weights": {"1": 3.0}}),
    ("7号权重设2,4号的权重是5", {"weights": {"7": 2.0, "4": 5.0}}),
    # a place that everybody is at, and numbers beside words that begin like "un"
    ("2 Mbit/s everywhere, 3 Mbit/s for user 4", {"min_rate_bps": {"all": 2e6, "4": 3e6}}),
    ("2 Mbit/s partout et 4 Mbit/s pour l'utilisateur 1", {"min_rate_bps": {"all": 2e6, "1": 4e6}}),
    ("überall 2 Mbit/s", {"min_rate_bps": 2e6}),
    ("max rate, 4 under 600k, 6 over 200k", {"max_rate_bps": {"4": 6e5}, "min_rate_bps": {"6": 2e5}}),
    ("用户1权重3,其他用户2", {"weights": {"1": 3.0, "all": 2.0}}),
    # who is served
    ("1号2号不用管", {"leave_out": ("1", "2")}),
    ("Nutzer 4 bleibt heute außen vor", {"leave_out": ("4",)}),
    ("seulement pour les usagers 1 et 3", {"users": ("1", "3")}),
    ("jeder mindestens anderthalb Mbit/s", {"min_rate_bps": 1.5e6}),
    ("the site has a fixed transmit power of 43 dBm", {"max_power_w": 10**1.3}),
    ("leave user 3 out", {"leave_out": ("3",)}),
    ("without users 2 and 3, 1 Mbit/s each", {"min_rate_bps": 1e6, "leave_out": ("2", "3")}),
    ("user 6 is not to be served", {"leave_out": ("6",)}),
    ("all users except number 4", {"leave_out": ("4",)}),
    ("skip user 2, at least 1 Mbit/s", {"min_rate_bps": 1e6, "leave_out": ("2",)}),
    ("skip #3 and #7", {"leave_out": ("3", "7")}),
    ("除了用户3,大家都至少1兆", {"min_rate_bps": {"all": 1e6, "3": 0.0}}),
    ("7号先别管", {"leave_out": ("7",)}),
    ("sans servir l'utilisateur 6", {"leave_out": ("6",)}),
    ("ohne Nutzer 2 und 3", {"leave_out": ("2", "3")}),
    ("serve only users 1, 2 and 5 with 10 W", {"max_power_w": 10.0, "users": ("1", "2", "5")}),
    ("only users 1 and 2, user 2 counts double", {"users": ("1", "2"), "weights": {"2": 2.0}}),
    ("only users 1 to 4", {"users": ("1", "2", "3", "4")}),
    ("只带1号和4号,每个人保底1.5兆", {"users": ("1", "4"), "min_rate_bps": 1.5e6}),
    ("cap user 1 at 3 Mbit/s, give everybody else at least 1 Mbit/s",
     {"min_rate_bps": {"all": 1e6, "1": 0.0}, "max_rate_bps": {"1": 3e6}}),
    ("weights 2:1:1 for users 1, 2, 3", {"weights": {"1": 2.0, "2": 1.0, "3": 1.0}}),
    ("users 1, 2, 3 get 1, 2, 3 Mbit/s", {"min_rate_bps": {"1": 1e6, "2": 2e6, "3": 3e6}}),
    ("switch off user 2 and cap user 3 at 1M", {"max_rate_bps": {"3": 1e6}, "leave_out": ("2",)}),
    ("Pc=3W and Pmax=12W, Rmin 200k", {"max_power_w": 12.0, "min_rate_bps": 2e5, "circuit_power_w": 3.0}),
    ("1: 1M, 2: 2M", {"min_rate_bps": {"1": 1e6, "2": 2e6}}),
    ("serve everyone but 4 and 5, 500k each", {"min_rate_bps": 5e5, "leave_out": ("4", "5")}),
    # corrections, ranges, totals
    ("at least 1 Mbit/s, sorry, 2 Mbit/s each", {"min_rate_bps": 2e6}),
    ("at most 3 Mbit/s each, I mean 2 Mbit/s", {"max_rate_bps": 2e6}),
    ("user 2 gets 1 Mbit/s, sorry, 2 Mbit/s", {"min_rate_bps": {"2": 2e6}}),
    ("rates between 500k and 2M for each user", {"min_rate_bps": 5e5, "max_rate_bps": 2e6}),
    ("10 W total, 0.2 W per subcarrier", {"max_power_w": 10.0, "subcarrier_max_power_w": 0.2}),
    # reliabilities without a percent sign
    ("1 Mbit/s each, five nines", {"min_rate_bps": 1e6, "outage_probability": 1e-5}),
    ("three nines reliability", {"outage_probability": 1e-3}),
    ("1 Mbit/s each, 99.999", {"min_rate_bps": 1e6, "outage_probability": 1e-5}),
    ("a reliability of 95", {"outage_probability": 0.05}),
    ("99.99 availability", {"outage_probability": 1e-4}),
    ("每人1兆,可靠性四个九", {"min_rate_bps": 1e6, "outage_probability": 1e-4}),
    ("1 Mbit/s par utilisateur, fiabilité 99,9", {"min_rate_bps": 1e6, "outage_probability": 1e-3}),
    ("cinco nueves", {"outage_probability": 1e-5}),
    ("vier Neunen", {"outage_probability": 1e-4}),
    # subcarriers, shares, circuits
    ("at most 0.5 W per subcarrier, groups of 4 subcarriers",
     {"subcarrier_max_power_w": 0.5, "resource_block_group_size": 4.0}),
    ("no subcarrier above 200 mW", {"subcarrier_max_power_w": 0.2}),
    ("每4个子载波一组", {"resource_block_group_size": 4.0}),
    ("with half the power", {"max_power_w": 10.0}),
    ("hand out four subcarriers at a time", {"resource_block_group_size": 4.0}),
    ("highest sum rate in groups of 12 with 5 W", {"resource_block_group_size": 12.0, "max_power_w": 5.0}),
    ("the subcarriers in pairs", {"resource_block_group_size": 2.0}),
    ("in Neunerblöcken", {"resource_block_group_size": 9.0}),
    ("as written in r3, 5 W", {"max_power_w": 5.0}),
    ("四个子载波一组地分", {"resource_block_group_size": 4.0}),
    ("at most seventy percent of the power", {"max_power_w": 14.0}),
    ("mit höchstens neun Zehnteln der Leistung", {"max_power_w": 18.0}),
    ("功率最多用七成", {"max_power_w": 14.0}),
    ("user twenty-one at least 1 Mbit/s", {"min_rate_bps": {"21": 1e6}}),
    ("al menos 1 Mbit/s para el usuario treinta y uno", {"min_rate_bps": {"31": 1e6}}),
    ("mindestens 1 Mbit/s für Nutzer siebenundzwanzig", {"min_rate_bps": {"27": 1e6}}),
    ("au moins 1 Mbit/s pour l'utilisateur vingt-deux", {"min_rate_bps": {"22": 1e6}}),
    ("28 at 2 Mbit/s or more", {"min_rate_bps": {"28": 2e6}}),
    ("2号起码1兆", {"min_rate_bps": {"2": 1e6}}),
    ("use 40 % of the power budget", {"max_power_w": 8.0}),
    ("only 6 W available, a fixed 35 watts for the electronics", {"max_power_w": 6.0, "circuit_power_w": 35.0}),
    ("P_c取1W,Pmax 33dBm", {"circuit_power_w": 1.0, "max_power_w": 10**0.3}),
    ("10 W, non, 12 W maximum", {"max_power_w": 12.0}),
    ("最多60W……算了,50W吧", {"max_power_w": 50.0}),
    ("höchstens 18 Watt, mit 99 % Zuverlässigkeit", {"max_power_w": 18.0, "outage_probability": 0.01}),
    ("43 dBm como mucho", {"max_power_w": 10**1.3}),
]  # fmt: skip

DOUBTED = [
    ("1 Mbit/s at most 10 W for sensors, and then user 9", "named_user"),
    ("serve only user 4 and leave user 4 out", "conflict"),
    ("user 2 at least 5 Mbit/s, user 2 at most 1 Mbit/s", "rates_crossed"),
    ("user 2 gets 5 Mbit/s, user 2 gets 1 Mbit/s", "conflict"),
    ("user 3 gets 1 Mbit/s, serve only user 3 and leave out user 3", "named_user"),
    ("with at most 10/user", "not_understood"),
    ("with 1e-9 W", "whose_power"),
    ("with an extra 2 W", "change"),
    ("1号和2号各1兆,其余人一半", "change"),
    ("功率5到10瓦", "power_floor"),
    ("功率10", "unit_missing"),
    ("功率降2瓦", "change"),
    ("10 Mbit/s split among 5 users", "total_rate"),
    ("users weigh 1, 2, 3", "unit_missing"),
    ("use 5 of the 20 W", "calculated"),
    ("10 W or 12 W", "conflict"),
    ("10 W if possible, else 12", "conflict"),
    ("10瓦或者12瓦", "conflict"),
    ("3号不超过2号", "named_user"),
    ("1 Mbit/s for users 2 and up", "some_users"),
    ("1 Mbit/s for odd users", "some_users"),
    ("单号用户1兆", "some_users"),
    ("1 Mbit/s for all users except the last", "some_users"),
    ("leave users out who have bad channels", "some_users"),
    ("groups of 0 subcarriers", "impossible"),
    ("120 % of the power", "impossible"),
    ("a 100 W bulb next door", "whose_power"),
    ("every second user gets 1 Mbit/s", "some_users"),
    ("at least 300 kbit/s for all but the last two", "some_users"),
    ("tous sauf les deux derniers au moins 300 kbit/s", "some_users"),
    ("alle außer den letzten beiden mindestens 300 kbit/s", "some_users"),
    ("todos menos los dos últimos al menos 300 kbit/s", "some_users"),
    ("除了最后两个都至少300k", "some_users"),
    ("serve the five best users", "some_users"),
    ("a third of the users get 1 Mbit/s", "some_users"),
    ("users 2, 4 and so on get 300 kbit/s", "some_users"),
    ("no one after user 5 is served", "some_users"),
    ("user 2 or 3 gets 1 Mbit/s", "one_of"),
    ("nothing for users 2, 3 or 4", "one_of"),
    ("Nutzer 2 oder 3 mindestens 1 Mbit/s", "one_of"),
    ("utilisateur 2 ou 3 au moins 1 Mbit/s", "one_of"),
    ("usuario 2 o 3 al menos 1 Mbit/s", "one_of"),
    ("2号或者3号至少1兆", "one_of"),
    ("on average 1 Mbit/s each", "another_figure"),
    ("each user averages 1 Mbit/s", "another_figure"),
    ("1 Mbit/s upload for user 3", "another_figure"),
    ("at most 10 W EIRP", "another_figure"),
    ("1 Mbit/s for user 3 most of the time", "another_figure"),
    ("at least 10 W", "power_floor"),
    ("Höchste Rate, mindestens 10 W", "power_floor"),
    ("débit maximal, 10 W au moins", "power_floor"),
    ("tasa máxima, más de diez vatios", "power_floor"),
    ("总速率最高，功率至少10瓦", "power_floor"),
    ("im Schnitt 1 Mbit/s je Nutzer", "another_figure"),
    ("1 Mbit/s de media por usuario", "another_figure"),
    ("1 Mbit/s en moyenne par utilisateur", "another_figure"),
    ("上行每人至少1兆", "another_figure"),
    ("users 1 and 2 together at least 3 Mbit/s", "total_rate"),
    ("Nutzer 1 und 2 zusammen mindestens 3 Mbit/s", "total_rate"),
    ("3 Mbit/s for users 4 and 5 combined", "total_rate"),
    ("sum of users 1 and 2 at least 3 Mbit/s", "total_rate"),
    ("least power, 5 Mbit/s shared by users 1 to 4", "total_rate"),
    ("30 W from the mains", "another_figure"),
    ("at most 43 dBm per antenna", "another_figure"),
    ("max rate, within 2 % of the optimum", "share"),
    ("max rate, 95 % coverage", "share"),
    ("highest rate, packet error rate 1 %", "share"),
    ("总速率最高，误码率1%", "share"),
    ("no user above 3 W", "power_per_user"),
    ("no more than 5 W per user", "power_per_user"),
    ("每个用户功率不超过2瓦", "power_per_user"),
    ("user 1 + user 2 >= 3 Mbit/s", "named_user"),
    ("2 W for user 3", "power_per_user"),
    ("user 3 uses 2 W", "power_per_user"),
    ("max rate, user 3 needs HD video", "named_user"),
    ("Maximize the total rate, user 3 above all", "named_user"),
    ("Gesamtrate maximieren, Nutzer 3 hat Vorrang", "named_user"),
    ("Maximise le débit total, l'utilisateur 3 d'abord", "named_user"),
    ("Maximiza la tasa total, prioridad al usuario 3", "named_user"),
    ("总速率最大,用户3回来了", "named_user"),
]

BY_PLACE = [
    ("users past 5 get 1 Mbit/s", "678"),
    ("everybody past user 5 gets 1 Mbit/s", "678"),
    ("at least 1 Mbit/s from user 6 on", "678"),
    ("1 Mbit/s for 6 and up", "678"),
    ("users 6+ at least 1 Mbit/s", "678"),
    ("as of user 6 at least 1 Mbit/s each", "678"),
    ("users up to 3 at least 1 Mbit/s", "123"),
    ("everyone before user 4 at least 1 Mbit/s", "123"),
    ("every third user gets 1 Mbit/s", "36"),
    ("Nutzer ab 6 mindestens 1 Mbit/s", "678"),
    ("alle nach Nutzer 5 mindestens 1 Mbit/s", "678"),
    ("jeder zweite Nutzer bekommt 1 Mbit/s", "2468"),
    ("usuarios del 6 en adelante al menos 1 Mbit/s", "678"),
    ("hasta el usuario 3 al menos 1 Mbit/s", "123"),
    ("à partir de l'utilisateur 6 au moins 1 Mbit/s", "678"),
    ("un utilisateur sur deux au moins 1 Mbit/s", "2468"),
    ("6号及以上至少1兆", "678"),
    ("4号之前的用户至少1兆", "123"),
    ("每隔一个用户至少1兆", "2468"),
]


FIGURES_OF_SOME: list[tuple[str, dict[str, Any]]] = [
    # each of those who are named right behind, and nobody else
    ("300k for all of users 1, 2 and 3", {"min_rate_bps": dict.fromkeys("123", 3e5)}),
    ("al menos 1 Mbit/s para cada uno de los usuarios 5 y 6", {"min_rate_bps": dict.fromkeys("56", 1e6)}),
    ("à 1 Mbit/s chacun des utilisateurs 1 et 2 et à 2 Mbit/s chacun des utilisateurs 4 à 6",
     {"min_rate_bps": dict.fromkeys("12", 1e6) | dict.fromkeys("456", 2e6)}),
    ("mindestens 300 kbit/s für jeden der Nutzer 5 und 8", {"min_rate_bps": dict.fromkeys("58", 3e5)}),
    ("jeder ungerade Nutzer mindestens 400 kbit/s", {"min_rate_bps": dict.fromkeys("1357", 4e5)}),
    ("a weight of two for each even-numbered user", {"weights": dict.fromkeys("2468", 2.0)}),
    ("每个双号用户保底300k", {"min_rate_bps": dict.fromkeys("2468", 3e5)}),
    # ranges in other words
    ("1 Mbit/s for everyone from user 3 to user 6", {"min_rate_bps": dict.fromkeys("3456", 1e6)}),
    ("from user 2 up to user 4 inclusive everyone gets at least 1 Mbit/s", {"min_rate_bps": dict.fromkeys("234", 1e6)}),
    ("desde el usuario 3 hasta el usuario 5 inclusive al menos 1 Mbit/s", {"min_rate_bps": dict.fromkeys("345", 1e6)}),
    ("1 Mbit/s pour tous de l'utilisateur 3 à l'utilisateur 5", {"min_rate_bps": dict.fromkeys("345", 1e6)}),
    ("Nutzer 2 bis einschließlich 4 mindestens 1 Mbit/s", {"min_rate_bps": dict.fromkeys("234", 1e6)}),
    ("用户2至用户4（含用户4）每人至少1兆", {"min_rate_bps": dict.fromkeys("234", 1e6)}),
    ("everyone from user 7 on at least 1 Mbit/s", {"min_rate_bps": dict.fromkeys("78", 1e6)}),
    # the first and the last few
    ("weight 3 for the first two and 2 for the last three", {"weights": {"1": 3, "2": 3, "6": 2, "7": 2, "8": 2}}),
    ("mindestens 1 Mbit/s für die letzten drei", {"min_rate_bps": dict.fromkeys("678", 1e6)}),
    ("los tres últimos con 2 Mbit/s como máximo", {"max_rate_bps": dict.fromkeys("678", 2e6)}),
    # whoever is excepted, and goes without
    ("all users but user 1, who is uncapped, are capped at 1 Mbit/s", {"max_rate_bps": dict.fromkeys("2345678", 1e6)}),
    ("außer Nutzer 1, dem nichts zugesagt wird, stehen allen je 1 Mbit/s zu", {"min_rate_bps": {"all": 1e6, "1": 0.0}}),
    ("all but user 2, to whom nothing is promised, get 1 Mbit/s at least", {"min_rate_bps": {"all": 1e6, "2": 0.0}}),
    ("without users 3 and 4 everyone gets at least 1 Mbit/s", {"min_rate_bps": 1e6, "leave_out": ("3", "4")}),
    ("user 1, who is uncapped, gets 2 Mbit/s at least", {"min_rate_bps": {"1": 2e6}}),
    # said once for several
    ("user 1 2 Mbit/s, user 2 3 Mbit/s, user 3 4 Mbit/s as caps", {"max_rate_bps": {"1": 2e6, "2": 3e6, "3": 4e6}}),
    ("用户1 2兆、用户2 3兆作为上限", {"max_rate_bps": {"1": 2e6, "2": 3e6}}),
    ("minimum of 2 Mbit/s for user 6, maximum of five for user 7",
     {"min_rate_bps": {"6": 2e6}, "max_rate_bps": {"7": 5e6}}),
    ("l'utilisateur 1 plafonné à 2 Mbit/s, le 2 à 3 Mbit/s", {"max_rate_bps": {"1": 2e6, "2": 3e6}}),
    ("la puissance ne dépassant pas 12 W ni aucun utilisateur 3 Mbit/s", {"max_power_w": 12.0, "max_rate_bps": 3e6}),
    ("que el usuario 3 no baje de 1 Mbit/s ni el 4 suba de 5 Mbit/s",
     {"min_rate_bps": {"3": 1e6}, "max_rate_bps": {"4": 5e6}}),
    ("un maximum de débit total avec 10 W", {"max_power_w": 10.0}),
    # shares and blocks
    ("on half its 20 W", {"max_power_w": 10.0}), ("mit der Hälfte ihrer 20 W", {"max_power_w": 10.0}),
    ("avec la moitié de ses 20 W", {"max_power_w": 10.0}),
    ("subcarriers are to be handed out in fours", {"resource_block_group_size": 4.0}),
    ("mit einem Zehntel der 20 W, die die Zelle senden kann", {"max_power_w": 2.0}),
    # a group without some of it
    ("at least 1 Mbit/s for users 1 to 4 except user 3", {"min_rate_bps": dict.fromkeys("124", 1e6)}),
    ("at least 1 Mbit/s for each odd user other than 7", {"min_rate_bps": dict.fromkeys("135", 1e6)}),
    ("users 1 to 4 except user 3, who needs 2 Mbit/s, get at least 1 Mbit/s",
     {"min_rate_bps": dict.fromkeys("124", 1e6) | {"3": 2e6}}),
    ("los usuarios 2 a 5, salvo el 4, al menos 1 Mbit/s", {"min_rate_bps": dict.fromkeys("235", 1e6)}),
    ("au moins 1 Mbit/s pour les utilisateurs pairs sauf le 4", {"min_rate_bps": dict.fromkeys("268", 1e6)}),
    ("Nutzer 1 bis 4 mit Ausnahme von Nutzer 3 mindestens 1 Mbit/s", {"min_rate_bps": dict.fromkeys("124", 1e6)}),
    ("双号用户(4号除外)至少1兆", {"min_rate_bps": dict.fromkeys("268", 1e6)}),
    ("除3号外,用户1到4至少1兆", {"min_rate_bps": dict.fromkeys("124", 1e6)}),
    # everybody but somebody who has a figure of their own, or goes without the one there is
    ("everyone but user 5, who needs 1 Mbit/s, gets 500k", {"min_rate_bps": {"all": 5e5, "5": 1e6}}),
    ("Keiner über 3 Mbit/s, Nutzer 6 ausgenommen, für den 8 Mbit/s die Grenze sind",
     {"max_rate_bps": {"all": 3e6, "6": 8e6}}),
    ("with all users at most 2 Mbit/s except user 3", {"max_rate_bps": dict.fromkeys("1245678", 2e6)}),
    ("除用户3外每人最多2兆", {"max_rate_bps": dict.fromkeys("1245678", 2e6)}),
    # by other words
    ("1 Mbit/s for everybody between user 2 and user 5", {"min_rate_bps": dict.fromkeys("2345", 1e6)}),
    ("du numéro 1 au numéro 3, chaque utilisateur reçoit au moins 1 Mbit/s",
     {"min_rate_bps": dict.fromkeys("123", 1e6)}),
    ("odd users at most 2 Mbit/s, even at most 1",
     {"max_rate_bps": dict.fromkeys("1357", 2e6) | dict.fromkeys("2468", 1e6)}),
    ("ungerade Nutzer höchstens 2 Mbit/s, gerade höchstens 1",
     {"max_rate_bps": dict.fromkeys("1357", 2e6) | dict.fromkeys("2468", 1e6)}),
    ("750 kbit/s para el usuario 3 y el doble para el usuario 5", {"min_rate_bps": {"3": 7.5e5, "5": 1.5e6}}),
    ("bits por julio al máximo con 600 kbit/s para el usuario 7", {"min_rate_bps": {"7": 6e5}}),
    ("Nutzer 7 maximal mit 600 kbit/s", {"max_rate_bps": {"7": 6e5}}),
    ("niemand soll 1 Mbit/s unterschreiten", {"min_rate_bps": 1e6}),
    ("1 Mbit/s chacun, une promesse sur vingt pouvant manquer", {"min_rate_bps": 1e6, "outage_probability": 0.05}),
]  # fmt: skip


def reading(text: str) -> Reading:
    return read_constraints(text, normalise(text), parse_quantities(text))


@pytest.mark.parametrize(("text", "stated"), STATED)
def test_what_is_stated(text: str, stated: dict[str, Any]) -> None:
    found = reading(text)
    assert not found.doubts
    assert same_constraints(found.values, stated), found.values


@pytest.mark.parametrize(("text", "key"), DOUBTED)
def test_what_is_asked_about(text: str, key: str) -> None:
    assert key in [doubt.key for doubt in reading(text).doubts]


@pytest.mark.parametrize(("text", "users"), BY_PLACE)
def test_users_by_where_they_stand_among_all(text: str, users: str) -> None:
    names = [f"user {number}" for number in range(1, 9)]
    found = read_constraints(text, normalise(text), parse_quantities(text), names=names)
    assert not found.doubts
    assert dict(found.values) == {"min_rate_bps": dict.fromkeys(users, 1e6)}


@pytest.mark.parametrize(("text", "stated"), FIGURES_OF_SOME)
def test_whose_figures_are_whose(text: str, stated: dict[str, Any]) -> None:
    said, names = as_meant(text), [f"user {number}" for number in range(1, 9)]
    found = read_constraints(said, normalise(said), parse_quantities(said), names=names)
    assert not found.doubts
    assert same_constraints(found.values, stated), found.values


@pytest.mark.parametrize(
    ("text", "bound"),
    [
        ("keep user 2 from falling below 1 Mbit/s", "min_rate_bps"),
        ("protect user 2 from dropping under 1 Mbit/s", "min_rate_bps"),
        ("keep user 2 from exceeding 1 Mbit/s", "max_rate_bps"),
        ("prevent user 2 from going over 1 Mbit/s", "max_rate_bps"),
        ("empêche l'utilisateur 2 de dépasser 1 Mbit/s", "max_rate_bps"),
    ],
)
def test_what_is_prevented_turns_a_bound_round(text: str, bound: str) -> None:
    assert dict(reading(text).values) == {bound: {"2": 1e6}}


@pytest.mark.parametrize("text", ["keep users above 2 Mbit/s", "every user over 2 Mbps", "alle Nutzer über 2 Mbit/s"])
def test_a_rate_is_no_place(text: str) -> None:
    assert dict(reading(text).values) == {"min_rate_bps": 2e6}


@pytest.mark.parametrize(
    "text", ["serve only users 1 and 2 with 10 W", "no more than 10 W altogether", "10 W zusammen"]
)
def test_a_power_of_all_is_a_limit(text: str) -> None:
    assert reading(text).values["max_power_w"] == 10.0


def test_a_share_is_of_the_cells_limit() -> None:
    text = "with a quarter of the power"
    found = read_constraints(text, text, parse_quantities(text), max_power_w=40.0)
    assert found.values["max_power_w"] == 10.0


def test_the_channels_own_names_are_users() -> None:
    text = "leave the lobby camera out, meter-7 gets 2 Mbit/s"
    found = read_constraints(text, text, parse_quantities(text), names=("meter-7", "lobby camera"))
    assert dict(found.values) == {"min_rate_bps": {"meter-7": 2e6}, "leave_out": ("lobby camera",)}
    assert not found.doubts


def test_amounts_to_add_and_missing_shares_are_kept_for_questions() -> None:
    assert reading("what would one more watt buy?").steps == {"power_w": 1.0}
    assert reading("what would another 3 W bring?").steps == {"power_w": 3.0}
    assert reading("what if 40 % were missing?").missing == 0.4
    assert reading("bring user 3 back").back == ("3",)


@pytest.mark.parametrize(
    "text",
    [
        "drop user 2's minimum",
        "ignore user 3's rate",
        "去掉4号的速率上限",
        "max rate, don't serve user 1 more than 2 Mbit/s",
        "不要给3号超过2兆，总速率最高",
    ],
)
def test_something_of_a_user_is_not_the_user(text: str) -> None:
    assert "leave_out" not in {*recognise(text).constraints, *recognise(text).pending}


def test_a_user_who_may_share_a_figure_is_asked_about() -> None:
    assert recognise("user 3 and 1 Mbit/s at most 10 W for sensors, user 9 too").kind == "clarify"
